// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "workshop.hpp"

#include <quadrant/diagnosis/diagnose.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

/// What the tests ask of a diagnosis.
namespace workshop {

using namespace quadrant::diagnosis;

inline diagnosis_result diagnosed(const machine_description& described_machine, const workshop::machine& real,
                                  double seconds = 8.15) {
    return diagnose(described_machine, workshop::as_log(workshop::run(real, seconds)));
}

/// Names that are claimed: blamed at one half or more.
inline std::vector<std::string> claims(const diagnosis_result& d) {
    std::vector<std::string> out;
    for (const cause& c : d.causes)
        if (c.probability >= 0.5) out.push_back(c.effect);
    return out;
}

/// For a message: the verdict and every suspect with its probability.
inline std::string said(const diagnosis_result& d) {
    std::string out = name_of(d.verdict);
    for (const cause& c : d.causes) out += fmt::format(" {} {:.2f}", c.effect, c.probability);
    return out + "; " + d.remaining_structure;
}

/// Whether a note has these words.
inline bool says(const diagnosis_result& d, const std::string& words) {
    return std::any_of(d.notes.begin(), d.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

inline const estimate& value_of(const cause& c, const std::string& key) {
    for (const auto& p : c.parameters)
        if (p.key == key) return p.values.at(0);
    FAIL("no parameter " << key);
    static const estimate none;
    return none;
}

/// The effect is named first and claimed, nothing else is, its parameter is found, and the gap shrinks to the
/// floor.
inline void named(const diagnosis_result& d, const std::string& effect, const std::string& key, double truth,
                  double within) {
    CAPTURE(effect);
    CAPTURE(said(d));
    CHECK(std::string(name_of(d.verdict)) == "explained");
    REQUIRE(claims(d) == std::vector{effect});
    const cause& c = d.causes.front();
    CHECK(c.effect == effect);
    CHECK(near(value_of(c, key).value, truth, within));
    CHECK(value_of(c, key).low < value_of(c, key).value);
    CHECK(value_of(c, key).high > value_of(c, key).value);
    CHECK(c.gap_after_force_rms_N.value < 0.5 * c.gap_before_force_rms_N.value);
    CHECK(c.shrink.low <= c.shrink.value);
    CHECK(c.shrink.value <= c.shrink.high);
}

/// Something is wrong and no name is claimed for it.
inline void abstains(const diagnosis_result& d) {
    CAPTURE(said(d));
    CHECK(d.verdict >= verdict::partly_explained);
    CHECK(claims(d).empty());
    CHECK(!d.remaining_structure.empty());
}

} // namespace workshop
