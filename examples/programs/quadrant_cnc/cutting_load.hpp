// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"
#include "law_of_drive.hpp"

#include <quadrant/base/in_si.hpp>
#include <quadrant/process/cutting_force.hpp>

#include <memory>

/// What the cutter does to an axis of the virtual machine.
namespace quadrant_cnc {

/// The force [N] of the cut on the table along one axis, whatever the number of its harmonics.
struct cutting_load {
    virtual ~cutting_load() = default;
    virtual double next() noexcept = 0; ///< of the coming period
    virtual void engage(bool in_the_cut) noexcept = 0;
};

namespace loads {

template <std::size_t Harmonics> class of final : public cutting_load {
public:
    of(const cutting_load_description& c, double newtons, double period)
        : mean_(newtons * c.mean),
          entry_("cutting_load.entry", quadrant::in_si(c.entry_s), quadrant::in_si(period)),
          harmonics_(parameters(c, newtons), quadrant::in_si(period)) {
        engage(false);
        harmonics_.settle({}, false), entry_.settle(false);
    }
    double next() noexcept override {
        const double mean = mean_ * entry_.depth();
        entry_.advance();
        return mean + harmonics_().value();
    }
    void engage(bool in_the_cut) noexcept override {
        harmonics_.engage(in_the_cut);
        entry_.engage(in_the_cut);
    }

private:
    using block = quadrant::cutting_force<Harmonics>;
    static typename block::parameters parameters(const cutting_load_description& c, double newtons) {
        typename block::parameters p{.fundamental = quadrant::in_si(c.spindle_Hz),
                                     .scale = quadrant::in_si(newtons),
                                     .harmonics = {},
                                     .entry = quadrant::in_si(c.entry_s)};
        for (std::size_t i = 0; i < Harmonics; ++i) {
            p.harmonics.real[i] = i < c.cosine.size() ? c.cosine[i] : 0;
            p.harmonics.imaginary[i] = i < c.sine.size() ? -c.sine[i] : 0;
        }
        return p;
    }

    double mean_;
    quadrant::tool_entry entry_; ///< of the mean, as the harmonics have it
    block harmonics_;
};

template <std::size_t Harmonics = 1>
std::unique_ptr<cutting_load> make(const cutting_load_description& c, std::size_t wanted, double newtons,
                                   double period) {
    if constexpr (Harmonics < cutting_load_description::most_harmonics)
        if (wanted > Harmonics) return make<Harmonics + 1>(c, wanted, newtons, period);
    return std::make_unique<of<Harmonics>>(c, newtons, period);
}

} // namespace loads

/// Null where the file has none. Throws quadrant::invalid_parameter for harmonics beyond half the servo rate.
inline std::unique_ptr<cutting_load> make_load(const axis_description& a, double period) {
    if (!a.load) return nullptr;
    // A torque on the screw is felt as a force on the table.
    const double newtons = a.load->torque ? 1 / pitch_per_radian(std::get<ball_screw_description>(a.drive)) : 1;
    return loads::make(*a.load, std::max(a.load->cosine.size(), a.load->sine.size()), newtons, period);
}

} // namespace quadrant_cnc
