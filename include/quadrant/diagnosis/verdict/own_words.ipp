// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine_file/machine_keys.hpp"
#include "../text/axis_words.hpp"

namespace quadrant::inline v0::diagnosis::detail {

QUADRANT_DIAGNOSIS_DECL void put_in_words(axis_kind kind, std::vector<parameter_estimate>& parameters) {
    for (auto& p : parameters) {
        const machine_key* key = key_named(p.key);
        p.key = key ? key->name_for(kind) : key_of(p.key, kind);
        if (key && !key->rule.holds(-1e-9)) // no interval holds what the file may not
            for (estimate& e : p.values) e.low = std::max(e.low, std::min(0.0, e.value));
    }
}
QUADRANT_DIAGNOSIS_DECL void put_in_words(axis_kind kind, std::vector<place>& places) {
    for (place& p : places) p.finding = text_of(p.finding, kind);
}
QUADRANT_DIAGNOSIS_DECL void put_in_words(axis_kind kind, std::vector<cause>& causes) {
    for (cause& x : causes) {
        put_in_words(kind, x.parameters);
        put_in_words(kind, x.with_suspects);
        for (reading& r : x.readings) put_in_words(kind, r.parameters);
        x.exciting_motion = text_of(x.exciting_motion, kind);
    }
}

} // namespace quadrant::inline v0::diagnosis::detail
