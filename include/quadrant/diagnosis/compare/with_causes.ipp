// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../apply.hpp"
#include "../effect/effect_list.hpp"
#include "../text/bad_input.hpp"

namespace quadrant::inline v0::diagnosis::detail::beside {

QUADRANT_DIAGNOSIS_DECL bool is_of_record(const std::string& effect) {
    const quadrant::diagnosis::effect* known = effect_named(effect);
    return known && known->keys.empty() && effect != "controller_mismatch";
}

QUADRANT_DIAGNOSIS_DECL std::optional<machine_description>
with_some(const machine_description& machine, diagnosis_result d,
          const std::function<bool(const cause&)>& keep) {
    std::erase_if(d.causes, [&](const cause& c) {
        return is_of_record(c.effect) || (c.effect == "controller_mismatch" && !is_claimed(c)) || !keep(c);
    });
    for (axis_result& a : d.axes) {
        a.calibrated.clear();
        a.calibrated_with_suspects.clear();
    }
    try {
        return apply(machine, std::move(d), 0);
    } catch (const bad_input&) {
        return {};
    }
}

QUADRANT_DIAGNOSIS_DECL machine_description with_causes(const machine_description& machine,
                                                        const diagnosis_result& d) {
    auto all = with_some(machine, d, [](const cause&) { return true; });
    if (!all) all = with_some(machine, d, is_claimed);
    if (all) return std::move(*all);
    return machine;
}

} // namespace quadrant::inline v0::diagnosis::detail::beside
