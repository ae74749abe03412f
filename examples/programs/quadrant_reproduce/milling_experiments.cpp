// SPDX-License-Identifier: BSL-1.0
#include "plants.hpp"

#include "experiment/cutting.hpp"
#include "experiment/ferraris.hpp"
#include "experiment/forces.hpp"
#include "experiment/harmonic_observer.hpp"
#include "experiment/real_cut.hpp"
#include "experiment/robustness.hpp"
#include "experiment/sensitivity.hpp"
#include "experiments.hpp"

std::vector<quadrant_reproduce::experiment> quadrant_reproduce::milling_experiments() {
    return {forces(),  harmonics(), ferraris_calibration(), harmonic_observer(),
            cutting(), real_cut(),  robustness(),           sensitivity()};
}
