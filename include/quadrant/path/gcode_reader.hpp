// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "arc_fit.hpp"
#include "gcode_block.hpp"

#include <cmath>
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace quadrant::inline v0::path {

/// Reads a G-code program, one move at a time; memory does not grow with the program.
/// Words: G0 G1 G2 G3 (I J from the start, or R; helix with Z; full circle with I J), G4 P [s], G17, G20 G21,
/// G61 (G61.1) exact stop, G64 [P] continuous with P as tolerance (none: joints must be tangent), G90 G91, F
/// per minute, N, O, comments in ( ) and after ;, a first and a last %. In any case, with or without blanks; in
/// a block every word once, one G word of each modal group. Before the program says otherwise: G21 G90 and the
/// ending of program_start.
/// Without effect, because they say what holds anyhow: G40 G49 G54 G80 G91.1 G94; because they do not move an
/// axis: S, T, M3 M4 M5 M7 M8 M9. M0 M1 M6 make the move before them end in a stop. M2 M30 end the program;
/// what follows is not read. Everything else is refused by its name. Source: [Kramer2000]; see docs/path.md.
/// A move to where the axes are (within 1 nm) is none.
/// Throws bad_program with file, line and column; after that there are no more moves. Allocates.
class gcode_reader {
public:
    /// `in` must outlive the reader; `name` is what messages call the file.
    gcode_reader(std::istream& in, std::string_view name, program_start start = {})
        : lines_(in, name), at_(start.place), target_(start.place), ending_(start.ending),
          tolerance_(start.tolerance) {}

    /// The next move; none at the end of the program. The last move ends in a stop.
    std::optional<move> next() {
        try {
            while (true) {
                if (const auto ready = moves_.take(done_)) return ready;
                if (done_) return {};
                read_block();
            }
        } catch (...) {
            done_ = true, moves_ = {};
            throw;
        }
    }
    std::size_t lines_read() const noexcept { return lines_.number(); }

private:
    using block = detail::gcode_block;
    using word = detail::gcode_word;
    static constexpr int no_motion = 800, clockwise = 20;

    void read_block() {
        if (!lines_.next()) return finish();
        const block b = detail::gcode_parser(lines_).block();
        if (b.percent && began_) return finish();
        began_ = began_ || !b.empty;
        obey(b);
        if (b.stop) moves_.stop();
        if (b.end) finish();
    }
    void finish() {
        done_ = true;
        moves_.stop();
        if (!moves_.any()) lines_.fail("holds no move");
    }

    void obey(const block& b) {
        if (const word& w = b[block::units]; w.given) unit_ = w.value == 200 ? 0.0254 : 1e-3;
        if (const word& w = b[block::distance_mode]; w.given) absolute_ = w.value == 900;
        if (const word& w = b[block::motion]; w.given) motion_ = int(w.value);
        if (const word& w = b['F']; w.given) {
            feed_ = w.value * unit_ / 60;
            if (!(feed_ > 0)) lines_.fail(w.at, "the feed is zero");
        }
        const word &dwell = b[block::non_modal], &control = b[block::path_control];
        if (control.given) {
            ending_ = control.value == 640 ? path_ending::continuous : path_ending::exact_stop;
            tolerance_ = ending_ == path_ending::continuous ? b['P'].value * unit_ : 0;
        }
        const bool goes = b['X'].given || b['Y'].given || b['Z'].given, centred = b['I'].given || b['J'].given;
        const bool round = motion_ == 20 || motion_ == 30;
        if (dwell.given) {
            if (!b['P'].given) lines_.fail(dwell.at, "G4 needs P, the time in seconds");
            if (goes || centred || b['R'].given || control.given || b[block::motion].given)
                lines_.fail(dwell.at, "G4 stands in a block of its own");
            return moves_.dwell(b['P'].value);
        }
        if (b['P'].given && !(control.given && control.value == 640))
            lines_.fail(b['P'].at, "P belongs to G4 or G64");
        if (!round || !(goes || centred || b['R'].given))
            for (const char letter : {'I', 'J', 'R'})
                if (b[letter].given)
                    lines_.fail(b[letter].at,
                                detail::joined({std::string_view(&letter, 1), " belongs to G2 or G3"}));
        if (!goes && !centred && !b['R'].given) return;
        const word& first = b['X'].given   ? b['X']
                            : b['Y'].given ? b['Y']
                            : b['Z'].given ? b['Z']
                            : b['I'].given ? b['I']
                                           : b['J'];
        if (motion_ == no_motion) lines_.fail(first.at, "no G0, G1, G2 or G3 says how to go there");
        if (motion_ != 0 && !(feed_ > 0)) lines_.fail(first.at, "the feed is zero: no F before this move");
        go(b, first.at, round);
    }

    void go(const block& b, std::size_t where, bool round) {
        for (int axis = 0; axis < 3; ++axis) {
            const word& w = b[char('X' + axis)];
            if (w.given) target_[axis] = (absolute_ ? 0 : target_[axis]) + w.value * unit_;
        }
        if (round) return add(circle(b, where));
        if (distance(at_, target_) > same_place) add(line(at_, target_));
    }
    arc circle(const block& b, std::size_t where) const {
        const bool to_the_right = motion_ == clockwise;
        const word& r = b['R'];
        if (r.given) {
            if (b['I'].given || b['J'].given) lines_.fail(r.at, "R and I J in one block");
            const double apart = std::hypot(target_.x - at_.x, target_.y - at_.y);
            if (apart <= same_place) lines_.fail(r.at, "an arc to where it starts needs I J, not R");
            const auto centre = arc_centre(at_, target_, r.value * unit_, to_the_right);
            const auto out = centre ? arc_about(at_, target_, *centre, to_the_right) : std::optional<arc>();
            if (!out)
                lines_.fail(r.at, detail::joined({"the end of the arc is not on it: start and end are ",
                                                  detail::in_mm(apart), " apart, the radius is ",
                                                  detail::in_mm(std::abs(r.value * unit_))}));
            return *out;
        }
        if (!b['I'].given && !b['J'].given) lines_.fail(where, "an arc needs I J or R");
        const std::size_t at = b['I'].given ? b['I'].at : b['J'].at;
        const point centre = at_ + unit_ * point{b['I'].value, b['J'].value, 0};
        if (!(distance({at_.x, at_.y}, {centre.x, centre.y}) > same_place))
            lines_.fail(at, "the radius of the arc is zero");
        const auto out = arc_about(at_, target_, centre, to_the_right);
        if (!out)
            lines_.fail(at,
                        detail::joined({"the end of the arc is not on it: its centre is ",
                                        detail::in_mm(std::hypot(at_.x - centre.x, at_.y - centre.y)),
                                        " from the start and ",
                                        detail::in_mm(std::hypot(target_.x - centre.x, target_.y - centre.y)),
                                        " from the end"}));
        return *out;
    }
    void add(const segment& path) {
        at_ = target_;
        moves_.add({.path = path,
                    .feed = motion_ == 0 ? 0 : feed_,
                    .rapid = motion_ == 0,
                    .ending = ending_,
                    .tolerance = tolerance_,
                    .line = lines_.number()});
    }

    detail::program_lines lines_;
    detail::waiting_moves moves_;
    point at_, target_; ///< end of the last move; where the words say that we are
    path_ending ending_;
    double tolerance_, feed_ = 0, unit_ = 1e-3;
    int motion_ = no_motion;
    bool absolute_ = true, began_ = false, done_ = false;
};

} // namespace quadrant::inline v0::path
