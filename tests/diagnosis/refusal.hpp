// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "quadrant/diagnosis/text/bad_input.hpp"

#include <string>

/// What the refusal of bad input says; "accepted" without one.
template <class Try> std::string refusal_of(Try attempt) {
    try {
        attempt();
    } catch (const quadrant::diagnosis::bad_input& fault) {
        return fault.what();
    }
    return "accepted";
}
