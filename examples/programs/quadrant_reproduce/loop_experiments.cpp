// SPDX-License-Identifier: BSL-1.0
#include "plants.hpp"

#include "experiment/dob_force.hpp"
#include "experiment/feedforward.hpp"
#include "experiment/forces.hpp"
#include "experiment/loop_margins.hpp"
#include "experiment/repetitive.hpp"
#include "experiment/responses.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::loop_experiments() {
    return {responses(), loop(),    loop_modes(), feedforward(), a_prime(),
            loop_dob(),  q_limit(), dob_force(),  repetitive()};
}
