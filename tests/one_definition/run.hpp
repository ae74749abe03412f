// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/error.hpp>

#include <array>

/// Eight machines for a second, in the instruction set of whoever compiles run.hpp; one entry for each set.
/// `through` are results of + - * / alone, `curved` of exp and sin too. `refused`: what a constructor says of a
/// bad lane.
struct result {
    std::array<double, 8> through, curved;
    quadrant::refused_parameter refused;
};
result run_baseline();
result run_avx2();
result run_avx512();
