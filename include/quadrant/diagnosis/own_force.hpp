// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace quadrant::diagnosis {

/// Where the axis is when a force of your own is asked for.
struct force_point {
    double position = 0, velocity = 0; ///< of the motor, in the middle of the step and before it [m], [m/s]
    double command = 0;                ///< that acts now, in the unit of the log's column
    double time = 0;                   ///< of the middle of the step, from the first row of the log [s]
    double step = 0;                   ///< length of the simulation's step [s], for a memory that integrates
};

/// A force that no list names, as code: what it is called, its numbers, its law. Made a suspect by `own_effect` (own_effect.hpp),
/// or put into a simulation by axis_description::own_forces.
struct own_force {
    /// One number of the law, and where a fit may take it.
    struct number {
        std::string_view key{}; ///< as files and reports call it; empty: not used
        double start = 0, low = 0, high = 0;
        bool logarithmic = false; ///< moves by ratio (low > 0)
    };
    static constexpr std::size_t most_numbers = 8, most_memory = 4;
    using values = std::array<double, most_numbers>;
    using memory = std::array<double, most_memory>; ///< 0 at the start of a log

    std::string_view name{}, box = "mechanics"; ///< or actuator, process
    std::string_view exciting_motion{};         ///< what motion shows it
    std::array<number, most_numbers> numbers{};
    /// Force on the axis [N], positive where it pushes towards larger positions. Asked once a step, in order and from several
    /// threads: what it remembers belongs into the memory. The velocity is that before the step: a force that changes with it
    /// by more than M / step per m/s is too stiff.
    double (*law)(const force_point&, const values&, memory&) = nullptr;

    constexpr std::size_t count() const {
        std::size_t n = 0;
        while (n < most_numbers && !numbers[n].key.empty()) ++n;
        return n;
    }
};

struct effect;

/// A force of your own as the diagnosis searches for it; `own_effect` makes one.
struct own_suspect {
    const own_force* force;
    const effect* searched;
};

/// The own forces of one model, each with its values. None cost nothing.
class own_forces {
public:
    static constexpr std::size_t most = 8;
    using memories = std::array<own_force::memory, most>;

    bool empty() const { return count_ == 0; }
    /// The values of a force; one that is not in the model yet joins it, all of them 0.
    own_force::values& of(const own_force& force) {
        std::size_t i = 0;
        while (i < count_ && each_[i].force != &force) ++i;
        if (i == most) throw std::length_error("a model holds at most 8 forces of your own");
        if (i == count_) each_[count_++].force = &force;
        return each_[i].values;
    }
    double at(const force_point& now, memories& remembered) const {
        double sum = 0;
        for (std::size_t i = 0; i < count_; ++i)
            sum += each_[i].force->law(now, each_[i].values, remembered[i]);
        return sum;
    }

private:
    struct one {
        const own_force* force = nullptr;
        own_force::values values{};
    };
    std::array<one, most> each_{};
    std::size_t count_ = 0;
};

} // namespace quadrant::diagnosis
