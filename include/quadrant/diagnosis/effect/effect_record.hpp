// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/key_value.hpp"
#include "machine_key.hpp"
#include "trial_machine.hpp"

namespace quadrant::inline v0::diagnosis {

struct parameter;
struct screening;

/// How common an effect is before any log is seen, against Coulomb friction with 1, and why.
struct prior_odds {
    double odds = 1;
    std::string_view reason{};
};

/// What an effect's numbers break in a machine file: the key, the rule, and where the rule has `{}` another key
/// of the box.
struct key_fault {
    std::string_view key{}, rule{}, other{}; ///< no key: nothing is wrong
};

/// One effect: the only place where its name, keys, law and words stand. What reads and writes files, words on
/// pages, tables in docs, the schema and the trial follow from the list of these (effects.hpp).
struct effect {
    std::string_view name{};
    std::string_view label{}; ///< as people call it: "Stribeck friction"
    std::string_view
        box{}; ///< of the loop; a machine file has boxes of the same names, "plant" for actuator and mechanics
    joint joins = joint::force;
    std::string_view exciting_motion{}; ///< what motion shows it
    /// Names that may be the same model on a record: they are one group while their predictions agree.
    std::array<std::string_view, 3> equivalent{};
    /// An effect that this one holds as a part: no second name for it.
    std::string_view holds{};
    /// Keys whose value says that it is another effect where it ends at the end of what is searched: no claim.
    std::array<std::string_view, 2> ends_inside{};
    /// Every axis has some of it: effects of this kind are tried together from the start, as in a linear
    /// regression.
    bool everyday = false;
    /// A law of the speed and nothing else: a motion of one speed does not distinguish it from another.
    bool of_speed = false;
    /// Calibrated values take its place on many records, and a fit that begins at them does not find back: it
    /// is searched from the described values, too.
    bool bends_calibration = false;
    /// A part of the friction that the file describes: where it describes none, this is free with the level,
    /// and no cause beside it.
    bool of_described_friction = false;
    /// It happens once, at a time of this record: no other motion, and no other record, shows it again.
    bool once = false;
    std::string_view shows{}; ///< as what it shows in the residual force
    key_list keys{};
    bool rotary_only = false;     ///< a linear axis cannot have it: no suspect there, and its keys are refused
    const own_law* law = nullptr; ///< of an effect whose law is no part of plant_model
    /// A rule between values, beyond those of single keys; refuses what no machine can be.
    key_fault (*fault)(const axis_description&) = nullptr;
    prior_odds prior{};
    std::string_view compensation{}; ///< the feedforward that pays it; empty: none does
    std::string_view remedy{};       ///< what the owner of the machine may do about it, one sentence
    /// The same with the numbers of a corrected plant, where no feedforward pays: plant, encoder count [m],
    /// unit of the command.
    std::string (*advice)(const plant_model&, double, std::string_view) = nullptr;
    trial_injection trial{};
    /// Ways to start the fit; each is the parameters it frees (they replace the described machine's own of the
    /// same key). None: it cannot be identified from this record. Null: it is found by other means than a fit
    /// of the plant.
    std::vector<std::vector<parameter>> (*starts)(const screening&) = nullptr;
    /// The machine file's keys with the values of a fitted model.
    std::vector<key_value> (*read)(const plant_model&) = nullptr;
    /// What the plant model needs before the parameters mean anything; most effects need nothing.
    void (*join)(plant_model&, const screening&) = [](plant_model&, const screening&) {};
    /// Another law of the same effect, as good on this record, would have up to this multiple of the first
    /// value read.
    double by_another_law = 1;
};

/// As people call an effect; its name where it has no label, as the owner's own have none.
inline std::string_view label_of(const effect& e) { return e.label.empty() ? e.name : e.label; }

/// Whether the sizes of an effect are those of a wave's harmonics.
constexpr bool is_wave(const effect& e) {
    return std::any_of(e.keys.begin(), e.keys.end(),
                       [](const machine_key& k) { return !k.components.empty(); });
}

/// Whether one of two effects names the other as the same model on some records.
constexpr bool may_be_one(const effect& a, const effect& b) {
    const auto names = [](const effect& one, const effect& other) {
        return std::find(one.equivalent.begin(), one.equivalent.end(), other.name) != one.equivalent.end();
    };
    return names(a, b) || names(b, a);
}

} // namespace quadrant::inline v0::diagnosis
