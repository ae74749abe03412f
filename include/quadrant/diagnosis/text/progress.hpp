// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"

#include <algorithm>
#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace quadrant::inline v0::diagnosis {

/// Hears how far a calculation is: one short line of what is going on, and the share of the work that is done,
/// 0 to 1. The share never falls. Made of a function of a line, or of a line and a share; without one, nothing
/// is heard. What that function throws ends the calculation. Heard on the thread that calls.
class progress {
public:
    progress() = default;
    template <class Heard>
    requires(!std::same_as<std::remove_cvref_t<Heard>, progress> &&
             (std::invocable<Heard&, const std::string&, double> || std::invocable<Heard&, const std::string&>))
        progress(Heard heard)
        : all_(std::make_shared<whole>()) { // implicit: a function is what a caller has
        if constexpr (std::invocable<Heard&, const std::string&, double>)
            all_->heard = std::move(heard);
        else
            all_->heard = [heard = std::move(heard)](const std::string& line, double) mutable { heard(line); };
    }

    /// `done`: the share of this part.
    void operator()(const std::string& line, double done) const {
        if (!all_) return;
        all_->done = std::max(all_->done, std::min(from_ + (to_ - from_) * std::clamp(done, 0.0, 1.0), 1.0));
        all_->heard(line, all_->done);
    }
    /// No more is known than that it goes on.
    void operator()(const std::string& line) const { (*this)(line, 0); }

    /// A part of this work, from one share of it to another. A line stands before those of the part.
    progress part(double from, double to, const std::string& before = {}) const {
        progress out = *this;
        out.from_ = from_ + (to_ - from_) * from;
        out.to_ = from_ + (to_ - from_) * to;
        if (all_ && !before.empty()) {
            const auto all = all_;
            out.all_ = std::make_shared<whole>();
            out.all_->done = all->done;
            out.all_->heard = [all, before](const std::string& line, double done) {
                all->done = std::max(all->done, done);
                all->heard(before + line, all->done);
            };
        }
        return out;
    }

private:
    struct whole {
        std::function<void(const std::string&, double)> heard{};
        double done = 0;
    };
    std::shared_ptr<whole> all_{};
    double from_ = 0, to_ = 1;
};

} // namespace quadrant::inline v0::diagnosis
