// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What the size of an effect is measured against when a trial puts it into a machine: numbers of the machine's
/// own motion without the effect.
struct trial_scale {
    double period = 0.0005;     ///< of the servo [s]
    double peak_command = 1;    ///< [V]
    double peak_force = 1;      ///< [N]
    double travel = 0.1;        ///< of this motion [m]
    double peak_velocity = 0.1; ///< [m/s]
    double seconds = 10;
    double crossover = 200; ///< of the velocity loop [rad/s]
};

/// A machine of a trial while an effect is put into it: its true numbers by machine key, and dice that fall the
/// same way at every amplitude. The simulator behind it is the trial's own.
class trial_machine {
public:
    double amplitude; ///< of the effect, relative to what its `into` says
    const trial_scale& around;

    /// The value of a key as the machine file describes it; 0: not described.
    virtual double described(std::string_view key) const = 0;
    /// The true value of a key.
    virtual double now(std::string_view key) const = 0;
    virtual void set(std::string_view key, double value) = 0;
    /// One value a harmonic; the truth that a trial compares with is the first.
    virtual void set(std::string_view key, const std::vector<double>& values) = 0;
    /// A value that the trial does not compare with: it may be found only up to another convention.
    virtual void set_untold(std::string_view key, const std::vector<double>& values) = 0;
    /// One number of the controller becomes another one by a factor of 1 + amplitude.
    virtual void change_controller() = 0;
    virtual double uniform() = 0; ///< 0 to below 1

    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
    bool chance(double probability) { return uniform() < probability; }
    double sign() { return chance(0.5) ? 1 : -1; }
    double phase() { return uniform(-std::numbers::pi, std::numbers::pi); }
    int whole(int low, int high) { return low + static_cast<int>(uniform() * (high - low + 1)); }

    /// The value times or over 1 + amplitude.
    double changed(double value, double upwards = 0.5) {
        return chance(upwards) ? value * (1 + amplitude) : value / (1 + amplitude);
    }
    /// A period that this motion passes at least twice.
    double passed_period() {
        return log_uniform(std::max(2e-3, around.travel / 25), std::max(5e-3, around.travel / 2.2));
    }
    /// Harmonics of falling size with random phases, under the keys of size and phase.
    void set_harmonics(std::string_view size_key, std::string_view phase_key, int harmonics, double size) {
        std::vector<double> sizes, phases;
        const double decay = uniform(0.2, 0.5);
        for (int k = 0; k < harmonics; ++k, size *= decay) {
            sizes.push_back(size);
            phases.push_back(phase());
        }
        set(size_key, sizes);
        set_untold(phase_key, phases);
    }

protected:
    trial_machine(double size, const trial_scale& scale) : amplitude(size), around(scale) {}
    ~trial_machine() = default;
};

/// How a trial puts an effect into a machine.
struct trial_injection {
    double low = 0, high = 0;               ///< of the amplitude
    void (*into)(trial_machine&) = nullptr; ///< null: no trial has it
    bool needs_coulomb = false;             ///< a machine file with Coulomb friction
    bool slow_shows_it = false;             ///< may be asked of one slow stroke
};

} // namespace quadrant::inline v0::diagnosis
