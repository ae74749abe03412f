// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "apply.hpp"
#include "apply.ipp"
#include "compare.hpp"
#include "compare.ipp"
#include "compensate.hpp"
#include "compensate.ipp"
#include "controller/kinds.hpp"
#include "controller/kinds.ipp"
#include "diagnose.hpp"
#include "diagnose.ipp"
#include "effect/effect_list.hpp"
#include "effect/effect_list.ipp"
#include "fit/predictor.hpp"
#include "fit/predictor.ipp"
#include "forecast.hpp"
#include "forecast.ipp"
#include "read_diagnosis.hpp"
#include "read_diagnosis.ipp"
#include "read_machine.hpp"
#include "read_machine.ipp"
#include "simulate.hpp"
#include "simulate.ipp"

/// The whole of the diagnosis, for the one file that makes it (text/separate_compilation.hpp).
#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    error                                                                                                     \
        "diagnosis/src.hpp is for programs that define QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION in all their files"
#endif
