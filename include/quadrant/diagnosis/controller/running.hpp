// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/in_si.hpp"
#include "../../control/axis_law.hpp"
#include "../machine/controller_description.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace quadrant::inline v0::diagnosis {

/// A controller as it runs, whatever its kind: one row in, its command out.
class running_controller {
public:
    running_controller() = default;
    virtual ~running_controller() = default;
    virtual std::unique_ptr<running_controller> copy() const = 0;
    /// The command of one row [V]. `asked` is the motion that is due lead() rows later.
    virtual double step(const axis_motion<>& asked, const axis_measurement<>& measured) = 0;
    /// Puts it into the middle of a motion: the row is its past. A kind that past() is not 0 for takes it as
    /// rest.
    virtual void settle(const loop_start& row) = 0;
    /// How many rows it has to see before its filters are where they would be: so many of an even motion before
    /// row 0 of a log, and as many of the log itself, whose commands are not compared. 0: settle(row) knows.
    virtual std::size_t past() const { return 0; }
    /// What the log says was applied of the last command: for a law whose state follows from that.
    virtual void applied(double) {}
    /// Whether a constant that is missing in its commands is shown in the last row only, which fixes its
    /// integral.
    virtual bool fixed_by_last_row() const { return false; }
    /// A row that it sees while its command is known. Returns the command that it has for the row from now on.
    virtual double show(const axis_motion<>& asked, const axis_measurement<>& measured, double command) {
        const double u = step(asked, measured);
        applied(command);
        return u;
    }
    /// Rows that the reference has to be ahead of the measurement.
    virtual std::size_t lead() const { return 0; }
    /// Whether an initial command that is not known stays in its commands, as that of an integral does.
    virtual bool remembers() const { return true; }
    virtual double due() const { return 0; } ///< the reference of the last row
    virtual bool limited() const { return false; }
    virtual bool faulted() const { return false; }

protected:
    running_controller(const running_controller&) = default;
    running_controller& operator=(const running_controller&) = default;
};

namespace detail {

/// What stands behind a law that has no limit and no converter of its own.
struct output_stage {
    double limit = std::numeric_limits<double>::infinity(), dac_step = 0;
    double operator()(double u) const noexcept {
        u = std::clamp(u, -limit, limit);
        return dac_step > 0 ? std::round(u / dac_step) * dac_step : u;
    }
};

/// A loop that reads positions only, by step(reference, measured) and settle(row).
template <class Loop> class positions_only final : public running_controller {
public:
    explicit positions_only(Loop loop) : loop_(std::move(loop)) {}
    std::unique_ptr<running_controller> copy() const override {
        return std::make_unique<positions_only>(*this);
    }
    double step(const axis_motion<>& asked, const axis_measurement<>& measured) override {
        due_ = asked.position.value();
        return loop_.step(due_, measured.position.value());
    }
    void settle(const loop_start& row) override { loop_.settle(row); }
    bool remembers() const override { return loop_.remembers(); }
    double due() const override { return due_; }
    bool limited() const override { return loop_.limited(); }
    bool faulted() const override { return loop_.faulted(); }

private:
    Loop loop_;
    double due_ = 0;
};

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
