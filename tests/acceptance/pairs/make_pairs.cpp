// SPDX-License-Identifier: BSL-1.0
// Long: make() draws in the order that a seed stands for.
// usage: pair_logs FOLDER SEED NUMBER...     FOLDER/NUMBER/a.csv, b.csv and machine.json of each, and
//                                            FOLDER/truth.json
// Pairs of machines of the trial's simulator with one description. 0 to 29 differ by one effect: twenty have
// nothing else, ten another effect in common. 30 to 59 are equal: ten have nothing, ten an effect in common,
// ten a force in common that is in no list. 60 to 69 differ by one effect beside such a force. Every machine
// lies anew inside the tolerances of the description; the two logs have motions, lengths and noise of their
// own, in every third pair the same motion.
#include "quadrant_gap/trial/files.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

using namespace quadrant_gap::trial;
constexpr std::size_t different = 30, equal = 30, most_draws = 60;
enum class common { nothing, effect, no_name };

/// Puts an effect into a machine at so many tolerance clouds.
void put(drawn_machine& m, const std::string& name, double clouds, std::uint64_t seed) {
    const auto& w = effect_named(name)->trial;
    const auto into = [&](insertion& i) {
        w.into(i);
        i.vary(name);
    };
    detail::put_in(m, name, w.low, w.high, into, clouds, seed);
}

bool runs(const drawn_machine& m, const std::vector<std::vector<double>>& references) {
    for (const axis_record& r : run(m.truth, references, m.period, m.noise_seed))
        if (std::isnan(r.position.back()) || std::abs(r.position.back() - r.reference.back()) >= 0.02 ||
            !(detail::travel(r.position) > 20 * m.described[0].encoder.resolution))
            return false;
    return true;
}

/// Whether the described machine can have this effect put in, as the trial has it.
bool takes(const axis_truth& described, const std::string& name) {
    return (!effect_named(name)->trial.needs_coulomb || described.friction.coulomb > 0) &&
           (name != "stribeck_friction" || described.friction.level_at_rest == 0);
}

ordered_json make(const std::filesystem::path& folder, std::uint64_t seed, std::size_t number) {
    const auto withheld = withheld_effects();
    dice turn(seed, 21);
    std::vector<std::string> names; // each in turn
    while (names.size() < different) {
        std::vector<std::string> bag;
        for (const auto* e : withheld) bag.emplace_back(e->name);
        turn.shuffle(bag);
        names.insert(names.end(), bag.begin(), bag.end());
    }
    const bool differ = number < different || number >= different + equal;
    const std::string effect = names[number % different];
    const common beside = number >= different + equal              ? common::no_name
                          : number % 3 == 1                        ? common::effect
                          : number % 3 == 2 && number >= different ? common::no_name
                                                                   : common::nothing;
    dice random(seed * 1000 + number, 22);
    for (std::size_t draws = 0; draws < most_draws; ++draws) {
        std::string both;
        while (beside == common::effect && (both.empty() || near_relatives(both, effect)))
            both = random.one_of(withheld)->name;
        planned p;
        p.what = beside == common::no_name ? kind::unknown : kind::none;
        p.two_axes = effect == "cross_coupling" || both == "cross_coupling";
        drawn_machine a = draw(seed * 1000 + number, 100 * number + draws, p);
        if (!takes(a.described[0], effect) || (!both.empty() && !takes(a.described[0], both))) continue;
        const axis_truth drawn = a.truth[0];
        a.truth = a.described;
        a.truth[0].unknown = drawn.unknown;
        a.truth[0].actuator.slew = drawn.actuator.slew;
        a.truth[0].actuator.soft_limit = drawn.actuator.soft_limit;
        a.excluded.clear();
        a.effects.clear();
        if (!both.empty()) put(a, both, random.log_uniform(3, 12), a.noise_seed + 1);
        drawn_machine b = a;
        b.noise_seed += 17;
        const bool in_second = random.chance(0.5);
        drawn_machine& other = in_second ? b : a;
        const std::size_t had = other.effects.size();
        if (differ) put(other, effect, random.log_uniform(3, 12), a.noise_seed + 2);
        if (std::any_of(other.effects.begin(), other.effects.end(),
                        [](const drawn_effect& e) { return !(e.size >= 2 && e.size < 30); }))
            continue;
        for (drawn_machine* m : {&a, &b})
            for (axis_truth& axis : m->truth) detail::move_inside(axis, m->tolerance, random);
        const auto& motion_of_b = number % 3 == number / 3 % 3 ? a.log_reference : b.holdout_reference;
        if (!runs(a, a.log_reference) || !runs(b, motion_of_b)) continue;
        std::filesystem::create_directories(folder);
        write_file(folder / "machine.json", machine_file(a).dump(2) + "\n");
        write_file(folder / "a.csv",
                   log_file(a, run(a.truth, a.log_reference, a.period, a.noise_seed), a.noise_seed));
        write_file(folder / "b.csv",
                   log_file(b, run(b.truth, motion_of_b, b.period, b.noise_seed), b.noise_seed));
        return {{"number", number},
                {"effect", differ ? effect : ""},
                {"size", differ ? other.effects[had].size : 0},
                {"in", !differ     ? ""
                       : in_second ? "second"
                                   : "first"},
                {"common", beside == common::no_name ? "a force in no list" : both}};
    }
    throw std::runtime_error("no machine with " + effect + " was drawn");
}

} // namespace

int main(int count, char** words) try {
    if (count < 4) throw std::runtime_error("usage: pair_logs FOLDER SEED NUMBER...");
    const std::filesystem::path folder = words[1];
    ordered_json truth = ordered_json::array();
    for (int k = 3; k < count; ++k)
        truth.push_back(make(folder / words[k], std::strtoull(words[2], nullptr, 10),
                             std::strtoull(words[k], nullptr, 10)));
    write_file(folder / "truth.json", truth.dump(1) + "\n");
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "pair_logs: %s\n", e.what());
    return 2;
}
