// SPDX-License-Identifier: BSL-1.0
// Long: one keyword of the language after the other.
#pragma once
#include "cl_arc.hpp"
#include "spline_moves.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iosfwd>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace quadrant::inline v0::path {

/// Reads a CL file (APT), one move at a time, three coordinates; memory does not grow with the file.
/// Moves: FROM/ (before the first), GOTO/, GODLTA/; RAPID for the next move; FEDRAT/ with MMPM, IPM, PERMIN or
/// neither (units per minute); UNITS/MM, INCHES (before: mm). DELAY/ seconds; STOP, OPSTOP, LOADTL, LOAD: the
/// move before them ends in a stop. END, FINI: the end. Arcs in the xy plane, as postprocessors write them:
///   CIRCLE/x,y,z,i,j,k,r then GOTO/ the end (Creo; NX with four numbers more): k = 1 counterclockwise, -1 clockwise
///   MOVARC/x,y,z,i,j,k,r,ANGLE,degrees then GOTO/ the end (Autodesk)
///   INDIRV/i,j,k and TLON,GOFWD/(CIRCLE/x,y,z,r),ON,n,INTOF,(LINE/x1,y1,z1,x2,y2,z2) (CATIA, APT): to the n-th
///   meeting of circle and line in the direction of INDIRV
/// SPLINE/QUINTIC or SPLINE/CUBIC ... SPLINE/OFF: one smooth path from where the tool is through the GOTO
/// places between them (spline_path.hpp). The word is ours: CL files have none that is common.
/// Read and without effect on the path: see no_effect below. Every other word is refused by its name, as are
/// tool axes other than z. Source: the forms of Creo, NX, Autodesk and CATIA, see docs/path.md. A GOTO to where
/// the tool is (within 1 nm) is none. Throws bad_program with file, line and column; after that there are no
/// more moves. Allocates.
class cl_reader {
public:
    /// `in` must outlive the reader; `name` is what messages call the file.
    cl_reader(std::istream& in, std::string_view name, program_start start = {})
        : statements_(in, name), start_(start), at_(start.place) {}

    /// The next move; none at the end of the program. The last move ends in a stop.
    std::optional<move> next() {
        try {
            while (true) {
                if (const auto ready = moves_.take(done_)) return ready;
                if (done_) return {};
                read_statement();
            }
        } catch (...) {
            done_ = true, moves_ = {};
            throw;
        }
    }
    std::size_t lines_read() const noexcept { return statements_.number(); }

private:
    using arguments = detail::cl_arguments;
    struct meaning {
        std::string_view word;
        void (cl_reader::*obey)(arguments&);
        bool in_spline = false;
    };
    static constexpr std::array<std::string_view, 17> no_effect{
        "PARTNO", "PPRINT", "REMARK", "TPRINT", "MACHIN", "CUTTER", "TLDATA", "TOOLNO",     "SPINDL",
        "COOLNT", "INTOL",  "OUTTOL", "TOLER",  "PAINT",  "TOOL",   "SELECT", "END-OF-PATH"};
    static constexpr std::array<std::string_view, 4> stops{"STOP", "OPSTOP", "LOADTL", "LOAD"};
    static bool among(const auto& words, std::string_view word) {
        return std::find(words.begin(), words.end(), word) != words.end();
    }
    static bool is_text(std::string_view major) { return among(no_effect, major) || among(stops, major); }

    void read_statement() {
        static constexpr std::array<meaning, 17> meanings{{{"FROM", &cl_reader::from},
                                                           {"GOTO", &cl_reader::go_to, true},
                                                           {"GODLTA", &cl_reader::go_by, true},
                                                           {"RAPID", &cl_reader::rapid},
                                                           {"FEDRAT", &cl_reader::feed, true},
                                                           {"UNITS", &cl_reader::units},
                                                           {"DELAY", &cl_reader::delay},
                                                           {"CIRCLE", &cl_reader::circle},
                                                           {"MOVARC", &cl_reader::circle},
                                                           {"INDIRV", &cl_reader::direction},
                                                           {"TLON", &cl_reader::along_circle},
                                                           {"SPLINE", &cl_reader::spline_run, true},
                                                           {"MULTAX", &cl_reader::only_off},
                                                           {"CUTCOM", &cl_reader::only_off},
                                                           {"TLAXIS", &cl_reader::tool_axis},
                                                           {"END", &cl_reader::finish},
                                                           {"FINI", &cl_reader::finish}}};
        if (!statements_.next(now_, is_text)) {
            now_.major = "end of the file", now_.line = statements_.number(), now_.column = 1;
            arguments none(now_, statements_.lines());
            return finish(none);
        }
        if (now_.major.empty() || among(no_effect, now_.major)) return;
        arguments rest(now_, statements_.lines());
        if (circle_ && now_.major != "GOTO") rest.fail("the arc before it wants GOTO, its end");
        if (among(stops, now_.major)) {
            if (run_) rest.fail("inside SPLINE; SPLINE/OFF ends it");
            return moves_.stop();
        }
        for (const meaning& m : meanings) {
            if (m.word != now_.major) continue;
            if (run_ && !m.in_spline) rest.fail("inside SPLINE; SPLINE/OFF ends it");
            return (this->*m.obey)(rest);
        }
        statements_.lines().fail(now_.line, now_.column,
                                 detail::joined({detail::in_quotes(now_.major), " is not supported"}));
    }

    void from(arguments& rest) {
        if (moves_.any()) rest.fail("after the first move");
        at_ = place(rest);
    }
    void go_to(arguments& rest) { go(place(rest), rest); }
    void go_by(arguments& rest) {
        rest.expect("/");
        const point step = unit_ * rest.place();
        rest.end();
        go(at_ + step, rest);
    }
    void rapid(arguments& rest) {
        rest.end();
        rapid_ = true;
    }
    void feed(arguments& rest) {
        rest.expect("/");
        std::optional<double> value;
        arguments number = rest;
        double per_minute = unit_;
        for (bool first = true; first || rest.take(","); first = false) {
            if (!value && rest.next_is(detail::cl_token::number))
                number = rest, value = rest.number();
            else if (rest.take("MMPM"))
                per_minute = 1e-3;
            else if (rest.take("IPM"))
                per_minute = 0.0254;
            else if (!rest.take("PERMIN"))
                rest.fail("a value with MMPM, IPM or PERMIN is what is supported");
        }
        rest.end();
        if (!value) rest.fail("a number is missing");
        feed_ = *value * per_minute / 60;
        if (!(feed_ > 0)) number.fail(feed_ < 0 ? "the feed is below zero" : "the feed is zero");
    }
    void units(arguments& rest) {
        rest.expect("/");
        const bool mm = rest.take("MM");
        if (!mm && !rest.take("INCHES") && !rest.take("INCH")) rest.fail("only MM and INCHES are supported");
        rest.end();
        unit_ = mm ? 1e-3 : 0.0254;
    }
    void delay(arguments& rest) {
        rest.expect("/");
        const double seconds = rest.number();
        rest.end();
        if (seconds < 0) rest.fail("must not be below 0");
        moves_.dwell(seconds);
    }
    void circle(arguments& rest) {
        detail::cl_circle read = detail::read_circle(rest, unit_);
        if (now_.major == "MOVARC") {
            rest.expect(",");
            rest.expect("ANGLE");
            rest.expect(",");
            read.angle = rest.number() * std::numbers::pi / 180;
            if (!(*read.angle > 0 && *read.angle <= 2 * std::numbers::pi * (1 + 1e-9)))
                rest.fail("the angle must lie between 0 and 360 degrees");
        } else if (rest.more()) { // NX: tolerance, its share inside, diameter and corner radius of the tool
            for (int k = 0; k < 4; ++k) {
                rest.expect(",");
                rest.number();
            }
        }
        rest.end();
        circle_ = read;
    }
    void direction(arguments& rest) {
        rest.expect("/");
        direction_ = rest.place();
        rest.end();
    }
    void along_circle(arguments& rest) {
        detail::cl_circle c;
        const point end = detail::read_to_line(rest, unit_, at_, direction_, c);
        direction_.reset();
        round(c, end, rest);
    }
    void only_off(arguments& rest) {
        rest.expect("/");
        if (!rest.next_is("OFF")) rest.fail("only OFF is supported");
        rest.expect("OFF");
        rest.end();
    }
    void tool_axis(arguments& rest) {
        rest.expect("/");
        if (rest.along_z() < 0) rest.fail("only 0,0,1 is supported here");
        rest.end();
    }
    void spline_run(arguments& rest) {
        rest.expect("/");
        const bool quintic = rest.take("QUINTIC"), cubic = !quintic && rest.take("CUBIC");
        if (!quintic && !cubic && !rest.take("OFF")) rest.fail("only QUINTIC, CUBIC and OFF are supported");
        rest.end();
        if ((quintic || cubic) == run_.has_value())
            rest.fail(run_ ? "inside SPLINE; SPLINE/OFF ends it" : "no spline");
        if (!run_) {
            run_.emplace(cubic ? spline_degree::cubic : spline_degree::quintic, at_, now_.line);
            return;
        }
        if (!run_->goes()) rest.fail("the spline goes nowhere: no GOTO in it");
        run_->finish(moves_, [&](std::string_view fault) { rest.fail(fault); });
        run_.reset();
        moves_.end_with(start_.ending, start_.tolerance);
    }
    void finish(arguments& rest) {
        if (run_) rest.fail("inside SPLINE; SPLINE/OFF ends it");
        if (circle_) rest.fail("the arc before it wants GOTO, its end");
        done_ = true;
        moves_.stop();
        if (!moves_.any()) statements_.lines().fail("holds no move");
    }

    point place(arguments& rest) {
        rest.expect("/");
        const point out = unit_ * rest.place();
        if (rest.take(",") && rest.along_z() < 0) rest.fail("only the tool axis 0,0,1 is supported");
        rest.end();
        return out;
    }
    void go(point to, arguments& rest) {
        if (run_) {
            if (distance(at_, to) <= same_place) rest.fail("the spline has two points at the same place");
            need_feed(rest);
            at_ = to;
            return run_->add(to, feed_, now_.line, moves_, [&](std::string_view fault) { rest.fail(fault); });
        }
        if (circle_) {
            const detail::cl_circle c = *circle_;
            circle_.reset();
            return round(c, to, rest);
        }
        if (distance(at_, to) > same_place) return add(line(at_, to), to, rest);
        rapid_ = false;
    }
    void round(const detail::cl_circle& c, point to, arguments& rest) {
        std::string fault;
        const auto path = detail::fit_circle(c, at_, to, fault);
        if (!path) rest.fail(fault);
        add(*path, to, rest);
    }
    void need_feed(arguments& rest) const {
        if (!(feed_ > 0)) rest.fail("the feed is zero: no FEDRAT before this move");
    }
    void add(const segment& path, point to, arguments& rest) {
        if (!rapid_) need_feed(rest);
        moves_.add({.path = path,
                    .feed = rapid_ ? 0 : feed_,
                    .rapid = rapid_,
                    .ending = start_.ending,
                    .tolerance = start_.tolerance,
                    .line = now_.line});
        at_ = to, rapid_ = false;
    }

    detail::cl_statements statements_;
    detail::cl_statement now_;
    detail::waiting_moves moves_;
    program_start start_;
    point at_; ///< end of the last move, or of the spline as far as it is read
    std::optional<point> direction_;
    std::optional<detail::cl_circle> circle_;
    std::optional<detail::spline_moves> run_;
    double feed_ = 0, unit_ = 1e-3;
    bool rapid_ = false, done_ = false;
};

} // namespace quadrant::inline v0::path
