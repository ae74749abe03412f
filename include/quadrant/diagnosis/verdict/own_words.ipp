// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../machine_file/machine_keys.hpp"
#include "../text/axis_words.hpp"

namespace quadrant::inline v0::diagnosis::detail {

QUADRANT_DIAGNOSIS_DECL void put_in_words(axis_kind kind, std::vector<parameter_estimate>& parameters) {
    for (auto& p : parameters) {
        const machine_key* key = key_named(p.key);
        p.key = key ? key->name_for(kind) : key_of(p.key, kind);
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
