// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "row.hpp"

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The numbers that the three sources print, each with where ours stands. This is the one place that says what
/// is published.
namespace quadrant_reproduce {

/// Where a printed number comes from.
enum class origin {
    simulated, ///< by the source, in its own simulation or on its model
    measured,  ///< by the source, on its machine or on the frequency response measured there
    given,     ///< a parameter that we use as it is printed
};

/// How a printed number follows from the row that it names.
enum class reading {
    value,      ///< the figure of the row
    reduction,  ///< by how many per cent it lies below the figure of the base row
    rise,       ///< by how much it lies above the figure of the base row
    difference, ///< how far it lies from the measured figure of the same row, as `base` prints it
    deviation,  ///< the same in per cent of that figure
};

/// One number as it is printed.
struct printed {
    std::string source, place, what; ///< [Jamaludin2008], Table 2.3, "x, gain margin"
    std::string text, unit;          ///< letter for letter
    origin from;
    std::string id{}, quantity{}; ///< ours is the figure of this row,
    std::optional<double> used{}; ///< or this constant of the program;
    std::string reason{};         ///< or there is none, and this is why; of a constant: why it differs
    double scale = 1;             ///< unit of the row over the printed unit
    reading how = reading::value; ///< what is done with the row
    std::string base_id{}, base_quantity{}; ///< of the other row
    double base = 0;                        ///< of the other printed number

    /// In the unit of the row.
    double value() const { return std::strtod(text.c_str(), nullptr) * scale; }
    /// Nothing is to be computed: the source lacks what one would need.
    bool cannot() const { return !reason.empty() && id.empty() && !used; }
};
using printed_list = std::vector<printed>;

/// Writes the numbers of one table or figure.
class printed_place {
public:
    printed_place(printed_list& into, std::string source, std::string place)
        : into_(&into), source_(std::move(source)), place_(std::move(place)) {}

    printed_place& simulated(std::string what, std::string text, std::string unit, std::string id,
                             std::string quantity, double scale = 1) {
        return row(origin::simulated, std::move(what), std::move(text), std::move(unit), std::move(id),
                   std::move(quantity), scale);
    }
    printed_place& measured(std::string what, std::string text, std::string unit, std::string id,
                            std::string quantity, double scale = 1) {
        return row(origin::measured, std::move(what), std::move(text), std::move(unit), std::move(id),
                   std::move(quantity), scale);
    }
    /// A parameter; `ours` is the constant of the program, in the printed unit.
    printed_place& used(std::string what, std::string text, std::string unit, double ours) {
        auto& p = add(origin::given, std::move(what), std::move(text), std::move(unit));
        p.used = ours;
        return *this;
    }
    printed_place& cannot(origin from, std::string what, std::string text, std::string unit,
                          std::string reason) {
        add(from, std::move(what), std::move(text), std::move(unit)).reason = std::move(reason);
        return *this;
    }
    /// Why the last entry's constant is not the printed one.
    printed_place& differs(std::string why) {
        into_->back().reason = std::move(why);
        return *this;
    }
    /// What the last entry's row says against another row.
    printed_place& against(reading how, std::string id, std::string quantity) {
        into_->back().how = how;
        into_->back().base_id = std::move(id);
        into_->back().base_quantity = std::move(quantity);
        return *this;
    }
    /// What the last entry's row says against another printed number, in the unit of the row.
    printed_place& against(reading how, double base) {
        into_->back().how = how;
        into_->back().base = base;
        return *this;
    }

private:
    printed& add(origin from, std::string what, std::string text, std::string unit) {
        into_->push_back({source_, place_, std::move(what), std::move(text), std::move(unit), from});
        return into_->back();
    }
    printed_place& row(origin from, std::string what, std::string text, std::string unit, std::string id,
                       std::string quantity, double scale) {
        auto& p = add(from, std::move(what), std::move(text), std::move(unit));
        p.id = std::move(id), p.quantity = std::move(quantity), p.scale = scale;
        return *this;
    }

    printed_list* into_;
    std::string source_, place_;
};

inline constexpr const char* thesis_source = "[Jamaludin2008]";
inline constexpr const char* vcnc_source = "[Yeung2006]";
inline constexpr const char* low_source = "[LowKeck2003]";

} // namespace quadrant_reproduce
