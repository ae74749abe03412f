// SPDX-License-Identifier: BSL-1.0
#pragma once

/// The diagnosis is made in every file that calls it, half a minute of compiling each. A program of several
/// such files defines QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION in all of them and includes
/// <quadrant/diagnosis/src.hpp> in one
/// more: the calls below are then declared only, and made there.
#ifdef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    define QUADRANT_DIAGNOSIS_DECL
#else
#    define QUADRANT_DIAGNOSIS_DECL inline
#endif
