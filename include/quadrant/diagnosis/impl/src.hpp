// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "apply.hpp"
#include "compensate.hpp"
#include "controllers.hpp"
#include "diagnose.hpp"
#include "effect_list.hpp"
#include "forecast.hpp"
#include "passes.hpp"
#include "read_diagnosis.hpp"
#include "read_machine.hpp"
#include "simulate.hpp"

/// The whole of the diagnosis, for the one file that makes it (separate_compilation.hpp).
#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    error "impl/src.hpp is for programs that define QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION in all their files"
#endif
