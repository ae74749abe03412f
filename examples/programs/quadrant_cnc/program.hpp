// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/base/in_si.hpp>
#include <quadrant/path/cl_reader.hpp>
#include <quadrant/path/gcode_reader.hpp>
#include <quadrant/trajectory/interpolator.hpp>

#include <algorithm>
#include <filesystem>
#include <variant>

namespace quadrant_cnc {

/// A part program, move by move: a CL file by its name (.cl, .cls, .apt), else G-code. Every move is one that
/// the machine can drive.
class program {
public:
    program(const cnc_description& cnc, const std::string& file)
        : cnc_(cnc), file_(file), in_(quadrant::path::open_program(file)), limits_(limits_of(cnc)) {
        quadrant::path::program_start start{
            .place = {cnc.trajectory.start_m[0], cnc.trajectory.start_m[1], cnc.trajectory.start_m[2]}};
        if (const auto tolerance = cnc.trajectory.corner_tolerance_m) {
            start.ending = quadrant::path::path_ending::continuous;
            start.tolerance = *tolerance;
        }
        std::error_code none;
        size_ =
            std::filesystem::is_regular_file(file, none) ? double(std::filesystem::file_size(file, none)) : 0;
        std::string kind = std::filesystem::path(file).extension().string();
        std::transform(kind.begin(), kind.end(), kind.begin(), quadrant::path::detail::upper);
        if (kind == ".CL" || kind == ".CLS" || kind == ".APT")
            reader_.emplace<quadrant::path::cl_reader>(in_, file, start);
        else
            reader_.emplace<quadrant::path::gcode_reader>(in_, file, start);
    }

    std::optional<quadrant::path::move> next() {
        auto move = std::visit(
            [](auto& reader) -> std::optional<quadrant::path::move> {
                if constexpr (requires { reader.next(); })
                    return reader.next();
                else
                    return {};
            },
            reader_);
        if (move) check(*move);
        return move;
    }
    const std::string& file() const { return file_; }
    /// How much of the file is read, 0 ... 1.
    double share() {
        const auto at = in_.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in);
        return size_ > 0 && at >= 0 ? std::min(1.0, double(at) / size_) : 0;
    }
    [[noreturn]] void refuse(std::size_t line, std::string_view message) const {
        throw quadrant::path::bad_program(fmt::format("{}:{}: {}", file_, line, message));
    }

    /// What the trajectory refuses: "line = 12: must ...".
    [[noreturn]] void refuse(const quadrant::invalid_parameter& fault) const {
        constexpr std::string_view begin = "line = ";
        const std::string_view text = fault.what();
        const std::size_t colon = text.find(": ");
        if (!text.starts_with(begin) || colon == text.npos)
            throw quadrant::path::bad_program(fmt::format("{}: {}", file_, text));
        throw quadrant::path::bad_program(fmt::format(
            "{}:{}: {}", file_, text.substr(begin.size(), colon - begin.size()), text.substr(colon + 2)));
    }

    static quadrant::trajectory::machine_limits limits_of(const cnc_description& cnc) {
        const auto as = [](const limits_description& l) {
            using quadrant::in_si;
            return quadrant::trajectory::motion_limits{in_si(l.velocity_m_per_s),
                                                       in_si(l.acceleration_m_per_s2), in_si(l.jerk_m_per_s3)};
        };
        quadrant::trajectory::machine_limits limits;
        limits.path = as(cnc.trajectory.limits);
        for (const axis_description& a : cnc.axes) limits.axis[a.axis] = as(a.limits);
        return limits;
    }
    static quadrant::trajectory::profile_kind kind_of(const cnc_description& cnc) {
        return static_cast<quadrant::trajectory::profile_kind>(cnc.trajectory.profile);
    }

private:
    struct range {
        double low, high;
    };
    /// How far a piece goes along an axis; exact for lines and arcs, from 64 places for a spline.
    static range reach(const quadrant::path::segment& path, int axis) {
        const double a = path.start()[axis], b = path.end()[axis];
        range r{std::min(a, b), std::max(a, b)};
        const auto take = [&](double x) { r = {std::min(r.low, x), std::max(r.high, x)}; };
        if (const auto* round = std::get_if<quadrant::path::arc>(&path.shape()); round && axis < 2) {
            const quadrant::path::point c = round->centre(), from = round->start() - c;
            const double start = std::atan2(from.y, from.x), end = start + round->sweep(),
                         quarter = std::numbers::pi / 2;
            for (double k = std::ceil(std::min(start, end) / quarter); k * quarter <= std::max(start, end); ++k)
                take(c[axis] + round->radius() * (axis == 0 ? std::cos(k * quarter) : std::sin(k * quarter)));
        } else if (std::holds_alternative<quadrant::path::spline>(path.shape())) {
            for (int i = 1; i < 64; ++i) take(path.position(path.length() * i / 64)[axis]);
        }
        return r;
    }
    void check(const quadrant::path::move& m) {
        constexpr double hair = 1e-9;
        for (int axis = 0; axis < 3; ++axis) {
            const range r = reach(m.path, axis);
            const char name = char('x' + axis);
            const auto found = std::find_if(cnc_.axes.begin(), cnc_.axes.end(), [&](const axis_description& a) {
                return a.axis == std::size_t(axis);
            });
            if (found == cnc_.axes.end()) {
                if (r.high - r.low > hair) refuse(m.line, fmt::format("the machine has no axis {}", name));
            } else if (r.low < found->from_m - hair || r.high > found->to_m + hair) {
                const bool low = r.low < found->from_m - hair;
                refuse(m.line,
                       fmt::format("axis {} would go to {:.9g} mm, beyond its limit {:.9g} mm", name,
                                   1e3 * (low ? r.low : r.high), 1e3 * (low ? found->from_m : found->to_m)));
            }
        }
        if (cnc_.trajectory.reach_the_feed && !m.rapid) check_feed(m);
        stopped_ = m.ending == quadrant::path::path_ending::exact_stop;
    }
    /// From rest to the feed, and from the feed to rest, where the block begins and ends with a stop.
    void check_feed(const quadrant::path::move& m) const {
        const int stops = stopped_ + (m.ending == quadrant::path::path_ending::exact_stop);
        if (stops == 0) return;
        namespace t = quadrant::trajectory;
        using quadrant::in_si;
        const t::bounds within = t::stretch(m.path, m.feed, limits_).within;
        try {
            t::profile one({.length = in_si(m.path.length() / stops),
                            .limits = {in_si(within.velocity), in_si(within.acceleration), in_si(within.jerk)},
                            .kind = kind_of(cnc_),
                            .to = in_si(within.velocity),
                            .line = m.line});
        } catch (const quadrant::invalid_parameter& fault) {
            refuse(fault);
        }
    }

    const cnc_description& cnc_;
    std::string file_;
    std::ifstream in_;
    quadrant::trajectory::plain_limits limits_;
    double size_ = 0;
    bool stopped_ = true; ///< where the next move begins
    std::variant<std::monostate, quadrant::path::gcode_reader, quadrant::path::cl_reader> reader_;
};

} // namespace quadrant_cnc
