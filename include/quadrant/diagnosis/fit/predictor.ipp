// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::diagnosis {

#ifdef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    ifdef QUADRANT_DIAGNOSIS_PASSES // the program has pass.hpp compiled for these sets too
extern const pass_table passes_avx2, passes_avx512;
const pass_table& passes() {
    static const pass_table& best = __builtin_cpu_supports("avx512f") ? passes_avx512
                                    : __builtin_cpu_supports("avx2")  ? passes_avx2
                                                                      : passes_of<>;
    return best;
}
#    else
const pass_table& passes() { return passes_of<>; }
#    endif
#endif

} // namespace quadrant::diagnosis
