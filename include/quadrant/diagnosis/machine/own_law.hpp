// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../plant/joint.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

using quadrant::joint; ///< where a law acts, and what its number means there

/// The word of a joint in tables and messages.
constexpr std::string_view name_of(joint where) {
    constexpr std::array<std::string_view, joint_count> names{"command",  "motor gain",   "force",
                                                              "friction", "transmission", "reading"};
    return names[static_cast<std::size_t>(where)];
}

/// Where the axis is when a law is asked.
using law_point = joint_point<double>;

/// An effect as code: its numbers, its law, and the joint where the law acts. `own_effect` (own_effect.hpp)
/// makes a suspect of it; axis_description::laws puts it into a simulation. An effect of the list may have one,
/// too.
struct own_law {
    /// One number of the law, and where a fit may take it.
    struct number {
        std::string_view key{}; ///< as files and reports call it; empty: not used
        double start = 0, low = 0, high = 0;
        bool logarithmic = false; ///< moves by ratio (low > 0)
    };
    static constexpr std::size_t most_numbers = 8, most_memory = 4;
    using values = std::array<double, most_numbers>;
    using memory = std::array<double, most_memory>; ///< 0 at the start of a log

    std::string_view name{}, box = "mechanics"; ///< or any other box of the loop
    joint joins = joint::force;
    std::string_view exciting_motion{}; ///< what motion shows it
    std::array<number, most_numbers> numbers{};
    /// What the law adds at its joint (see `joint`), from the point and the numbers. A force is positive where
    /// it pushes towards larger positions. The law is called once a step, in order, from several threads: what
    /// it remembers belongs into the memory. The velocity is that before the step: a force that changes with it
    /// by more than M / step per m/s is too stiff.
    double (*law)(const law_point&, const values&, memory&) = nullptr;

    /// How many numbers the law has.
    constexpr std::size_t count() const {
        std::size_t n = 0;
        while (n < most_numbers && !numbers[n].key.empty()) ++n;
        return n;
    }
    /// Index of the number with this key; count(): none has it.
    constexpr std::size_t index_of(std::string_view key) const {
        std::size_t i = 0;
        while (i < count() && numbers[i].key != key) ++i;
        return i;
    }
};

/// The laws of one model, each with its values. A model without laws pays nothing for them.
class own_laws {
public:
    static constexpr std::size_t most = 8;
    using memories = std::array<own_law::memory, most>;

    bool empty() const { return count_ == 0; }
    /// The values of a law; one that is not in the model yet joins it, all of them 0.
    own_law::values& of(const own_law& law) {
        std::size_t i = 0;
        while (i < count_ && each_[i].law != &law) ++i;
        if (i == most) throw std::length_error("a model holds at most 8 laws of effects");
        if (i == count_) each_[count_++].law = &law;
        return each_[i].values;
    }
    /// Sum of what the laws of one joint add there.
    double sum(joint where, const law_point& now, memories& remembered) const {
        double sum = 0;
        for (std::size_t i = 0; i < count_; ++i)
            if (each_[i].law->joins == where) sum += each_[i].law->law(now, each_[i].values, remembered[i]);
        return sum;
    }
    /// Whether a law acts at this joint.
    bool any_at(joint where) const {
        for (std::size_t i = 0; i < count_; ++i)
            if (each_[i].law->joins == where) return true;
        return false;
    }

private:
    struct one {
        const own_law* law = nullptr;
        own_law::values values{};
    };
    std::array<one, most> each_{};
    std::size_t count_ = 0;
};

} // namespace quadrant::inline v0::diagnosis
