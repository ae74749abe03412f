// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../path/move.hpp"
#include "corner.hpp"
#include "profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace quadrant::inline v0::trajectory {

/// The next moves of a path and how fast each joint may be passed, so that the speed can always come down in
/// time: up to Window moves; beyond the last one known the path is taken to end. Moves that follow smoothly
/// (tangent and curvature, limits alike) are one piece, at most Window/4 of them; joints of pieces are passed
/// without acceleration along the path.
/// Backwards over the window: the highest speed at the start of a piece from which that at its end can be
/// reached; forwards,
/// when a piece is begun: what can be reached from the speed there is. A longer look-ahead never lowers the
/// speed of a joint, so that what is under way stays valid.
/// Source: [Altintas2012]; [Tajima2016] for the joints (`corner`).
/// Refused, with the line: a gap in the path, no feed, a corner to be driven through with no tolerance.
/// Plain SI numbers; only `push` may throw, nothing allocates. For the motion itself: `interpolator`.
template <std::size_t Window = 128> class look_ahead {
    static_assert(Window >= 2);

public:
    /// Moves that are driven as one, and the speed at which they are entered.
    struct piece {
        stretch whole;
        corner joint; ///< with the piece before it
        std::size_t moves = 1;
        double speed = 0;     ///< planned at that joint [m/s]
        bool settled = false; ///< no further move makes it faster
        double dwell_before = 0, dwell = 0;
    };
    /// A piece that is begun.
    struct course {
        double leg_in = 0;  ///< of the joint behind, along this piece [m]
        double out = 0;     ///< speed at its end [m/s]; 0: a stop
        double leg_out = 0; ///< of the joint ahead [m]
        speed_profile body; ///< between the two
    };
    /// A place on the path: the segment, the distance along it [m], its line in the program.
    struct place {
        const path::segment* path;
        double s; ///< along it
        std::size_t line;
    };

    look_ahead(const machine_limits& limits, profile_kind kind, quadrant::duration period)
        : machine_(limits), kind_(kind), period_(period.value()) {}

    bool full() const noexcept { return known_ == Window; }
    std::size_t pieces() const noexcept { return count_; }
    const piece& front() const noexcept { return *at(0); }
    const corner& joint_ahead() const noexcept { return at(1)->joint; }
    /// Where s is: on the first piece, or on the one behind it.
    place on_front(double s) const noexcept { return on(0, front().moves, s); }
    place on_second(double s) const noexcept { return on(front().moves, at(1)->moves, s); }
    /// Forgets all; the next move may start anywhere.
    void clear() noexcept {
        while (count_ > 0) pop();
        last_.reset();
    }

    /// Needs !full(). Throws for what is refused and changes nothing then.
    void push(const path::move& next) {
        double feed = next.feed;
        if (next.rapid) feed = unlimited;
        const stretch driven(next.path, feed, machine_);
        check(next, driven);
        const bool on = last_ && last_->ending == path::path_ending::continuous && count_ > 0;
        if (on && count_ > planned_ && !(count_ == 1 && begun_) && alike(*at(count_ - 1), driven)) {
            piece& last = *at(count_ - 1);
            last.whole = last.whole.joined(driven);
            last.dwell = next.dwell;
            ++last.moves;
            if (tolerance_ >= 0)
                last.joint = corner(at(count_ - 2)->whole, last.whole, tolerance_, kind_, machine_);
        } else {
            corner joint;
            tolerance_ = -1;
            if (on)
                joint = corner(at(count_ - 1)->whole, driven, tolerance_ = last_->tolerance, kind_, machine_);
            at(count_++) = piece{driven, joint, 1, 0, false, next.dwell_before, next.dwell};
        }
        move_at(known_++) = next;
        last_ = next;
    }

    /// How the first piece is driven when it is entered with this speed; fixes the joint at its end.
    course begin(double in) noexcept {
        begun_ = true;
        course c;
        const piece& now = front();
        c.leg_in = now.joint.leg(in);
        if (count_ > 1) {
            piece& next = *at(1);
            const std::size_t fresh = count_ - planned_;
            if (!next.settled && (fresh >= Window / 4 || (fresh > 0 && planned_ <= Window / 2))) plan();
            const quickest_change change(kind_, now.whole.within);
            c.out = highest(std::min(in, next.speed), next.speed, enough(now), [&](double out) {
                return room(now, c.leg_in, change(in, out), next.joint.leg(out));
            });
            next.speed = c.out;
            c.leg_out = next.joint.leg(c.out);
        }
        const double length = std::max(0.0, now.whole.length - c.leg_in - c.leg_out);
        c.body = speed_profile(kind_, now.whole.within, length, in, c.out);
        return c;
    }
    void pop() noexcept {
        for (std::size_t i = front().moves; i > 0; --i, --known_) {
            move_at(0).reset();
            first_move_ = (first_move_ + 1) % Window;
        }
        at(0).reset();
        first_ = (first_ + 1) % Window;
        --count_;
        if (planned_ > 0) --planned_;
        begun_ = false;
    }

private:
    std::optional<piece>& at(std::size_t i) noexcept { return pieces_[(first_ + i) % Window]; }
    const std::optional<piece>& at(std::size_t i) const noexcept { return pieces_[(first_ + i) % Window]; }
    std::optional<path::move>& move_at(std::size_t i) noexcept { return moves_[(first_move_ + i) % Window]; }
    const std::optional<path::move>& move_at(std::size_t i) const noexcept {
        return moves_[(first_move_ + i) % Window];
    }
    static double enough(const piece& p) noexcept { return 1e-6 * p.whole.length; }

    place on(std::size_t first, std::size_t moves, double s) const noexcept {
        std::size_t i = first;
        for (double l = 0; i + 1 < first + moves && s > (l = move_at(i)->path.length()); ++i) s -= l;
        return {&move_at(i)->path, s, move_at(i)->line};
    }
    void check(const path::move& next, const stretch& driven) const {
        using quadrant::detail::shortest;
        if (!next.rapid && !(next.feed > 0)) refuse_line(next.line, "the feed must be above 0");
        if (!(next.tolerance >= 0)) refuse_line(next.line, "the corner tolerance must not be below 0");
        if (!(driven.within.velocity < unlimited))
            refuse_line(next.line, "a rapid move needs a limit of velocity, of the path or of its axes");
        if (!last_) return;
        const double gap = distance(last_->path.end(), next.path.start());
        if (!(gap <= 1e-9))
            refuse_line(next.line,
                        "the move must begin where the last one ended, not " + shortest(gap) + " m from it");
        const double turn = distance(driven.first_tangent, last_->path.tangent(last_->path.length()));
        if (last_->ending == path::path_ending::continuous && !(last_->tolerance > 0) && turn > 1e-3)
            refuse_line(
                last_->line,
                "the path turns by " +
                    shortest(std::round(std::asin(std::min(1.0, 0.5 * turn)) * 11459.155902616465) / 100) +
                    " degrees at its end: it must stop there or have a corner tolerance above 0");
    }
    bool alike(const piece& last, const stretch& next) const noexcept {
        const auto near = [](double a, double b, double ratio) {
            return a == b || (a > ratio * b && b > ratio * a);
        };
        return last.moves < Window / 4 && last.whole.goes_on_in(next) &&
               near(last.whole.within.velocity, next.within.velocity, 0.8) &&
               near(last.whole.within.acceleration, next.within.acceleration, 0.5) &&
               near(last.whole.within.jerk, next.within.jerk, 0.5);
    }
    /// What is left of a piece [m] when the speed changes so between its two joints; below 0: it cannot. A stop
    /// keeps one period in hand, so that its time can be fitted to whole periods.
    double room(const piece& p, double leg_in, const speed_change& by, double leg_out) const noexcept {
        return p.whole.length - leg_in - by.distance() - leg_out - (by.to > 0 ? 0 : by.from * period_);
    }
    /// Backwards from the newest piece to the second, or to what no further move can change: a joint at its
    /// highest speed, and all before it.
    void plan() noexcept {
        bool settled = false;
        for (std::size_t i = count_ - 1; i >= 1; --i) {
            piece& p = *at(i);
            if (p.settled) break;
            const bool newest = i + 1 == count_;
            const double out = newest ? 0 : at(i + 1)->speed, most = p.joint.most();
            const double leg_out = newest ? 0 : at(i + 1)->joint.leg(out);
            const quickest_change change(kind_, p.whole.within);
            p.speed = most <= out ? most : highest(out, most, enough(p), [&](double in) {
                return room(p, p.joint.leg(in), change(in, out), leg_out);
            });
            settled = settled || p.speed == most;
            p.settled = settled;
        }
        planned_ = count_;
    }

    plain_limits machine_;
    profile_kind kind_;
    double period_, tolerance_ = -1; ///< tolerance of the newest joint [m]; -1: a stop
    std::array<std::optional<piece>, Window> pieces_{};
    std::array<std::optional<path::move>, Window> moves_{};
    std::size_t first_ = 0, count_ = 0, planned_ = 0, first_move_ = 0, known_ = 0;
    bool begun_ = false; ///< the first piece
    std::optional<path::move> last_;
};

} // namespace quadrant::inline v0::trajectory
