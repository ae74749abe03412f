// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "arc_fit.hpp"
#include "cl_arguments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace quadrant::inline v0::path::detail {

/// A circle of a CL file whose end comes with the next GOTO.
struct cl_circle {
    point centre;      ///< [m]
    double radius = 0; ///< [m]
    bool clockwise = false;
    std::optional<double> angle; ///< of the arc [rad], above 0
};

/// x,y,z,i,j,k,r behind CIRCLE/ or MOVARC/ ; what follows is the caller's.
inline cl_circle read_circle(cl_arguments& from, double unit) {
    cl_circle out;
    from.expect("/");
    out.centre = unit * from.place();
    from.expect(",");
    out.clockwise = from.along_z() < 0;
    from.expect(",");
    out.radius = unit * from.number();
    return out;
}

/// The arc from `start` to `end`, or why there is none.
inline std::optional<arc> fit_circle(const cl_circle& c, point start, point end, std::string& fault) {
    const double from_start = std::hypot(start.x - c.centre.x, start.y - c.centre.y),
                 from_end = std::hypot(end.x - c.centre.x, end.y - c.centre.y);
    if (!(std::abs(from_start - c.radius) <= std::min(arc_end_tolerance, 0.1 * c.radius))) {
        fault = joined({"the start of the arc is not on it: it is ", in_mm(from_start),
                        " from the centre, the radius is ", in_mm(c.radius)});
        return {};
    }
    const auto out = arc_about(start, end, c.centre, c.clockwise);
    if (!out)
        fault = joined({"the end of the arc is not on it: its centre is ", in_mm(from_start),
                        " from the start and ", in_mm(from_end), " from the end"});
    constexpr double degree = std::numbers::pi / 180;
    if (out && c.angle && std::abs(std::abs(out->sweep()) - *c.angle) > degree) {
        fault = joined({"the end of the arc is not on it: ANGLE says ", std::to_string(*c.angle / degree),
                        " degrees, the end is at ", std::to_string(std::abs(out->sweep()) / degree)});
        return {};
    }
    return out;
}

/// Where travel from `start` along the circle meets the line through a and b for the n-th time; the start
/// itself, met again after a turn, comes last. None when there are not so many.
inline std::optional<point> nth_meeting(const cl_circle& c, point start, point a, point b, int n) {
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (!(length > same_place)) return {};
    const double tx = (b.x - a.x) / length, ty = (b.y - a.y) / length;
    const double along = (c.centre.x - a.x) * tx + (c.centre.y - a.y) * ty; // foot of the centre on the line
    const double off = (c.centre.x - a.x) * ty - (c.centre.y - a.y) * tx;
    if (!(std::abs(off) <= c.radius)) return {};
    const double half = std::sqrt((c.radius - off) * (c.radius + off));
    std::array<point, 2> meet{point{a.x + (along - half) * tx, a.y + (along - half) * ty, start.z},
                              point{a.x + (along + half) * tx, a.y + (along + half) * ty, start.z}};
    const auto travel = [&](point p) {
        const double turn = 2 * std::numbers::pi, way = c.clockwise ? -1 : 1;
        double angle = way * (std::atan2(p.y - c.centre.y, p.x - c.centre.x) -
                              std::atan2(start.y - c.centre.y, start.x - c.centre.x));
        angle -= turn * std::floor(angle / turn);
        return angle * c.radius <= arc_end_tolerance ? turn : angle;
    };
    if (travel(meet[1]) < travel(meet[0])) std::swap(meet[0], meet[1]);
    point& end = meet[n == 1 ? 0 : 1];
    if (distance(end, start) <= arc_end_tolerance) end = start;
    return end;
}

/// ,GOFWD/(CIRCLE/x,y,z,r),ON,n,INTOF,(LINE/x1,y1,z1,x2,y2,z2) behind TLON; `n,INTOF,` may be missing. The
/// sense of the circle is that of INDIRV. Returns the end.
inline point read_to_line(cl_arguments& from, double unit, point start, const std::optional<point>& indirv,
                          cl_circle& c) {
    const auto expect = [&](std::initializer_list<std::string_view> parts) {
        for (const std::string_view part : parts) from.expect(part);
    };
    expect({",", "GOFWD", "/", "(", "CIRCLE", "/"});
    c.centre = unit * from.place();
    expect({","});
    c.radius = unit * from.number();
    expect({")", ",", "ON", ","});
    int n = 1;
    if (from.next_is(cl_token::number)) {
        n = from.next_is("1") ? 1 : 2;
        if (n == 2 && !from.next_is("2")) from.fail("a circle and a line meet once or twice");
        from.number();
        expect({",", "INTOF", ","});
    }
    expect({"(", "LINE", "/"});
    const point a = unit * from.place();
    expect({","});
    const point b = unit * from.place();
    expect({")"});
    from.end();
    if (!indirv) from.fail("no INDIRV before it");
    const double rx = start.x - c.centre.x, ry = start.y - c.centre.y,
                 turning = rx * indirv->y - ry * indirv->x;
    if (!(std::abs(turning) > 1e-3 * std::hypot(rx, ry) * magnitude(*indirv)))
        from.fail("INDIRV does not say which way round");
    c.clockwise = turning < 0;
    const auto end = nth_meeting(c, start, a, b, n);
    if (!end) from.fail("the end of the arc is not on it: the line does not meet the circle");
    return *end;
}

} // namespace quadrant::inline v0::path::detail
