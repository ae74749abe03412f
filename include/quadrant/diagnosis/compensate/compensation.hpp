// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "../controller/kinds.hpp"
#include "../effect/effect.hpp"
#include "compensation_result.hpp"

#include <fmt/format.h>

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL void set_keys(controller_description& c, const std::vector<key_value>& keys);

QUADRANT_DIAGNOSIS_DECL std::vector<key_value> settings_of(const level_block::parameters& p);
QUADRANT_DIAGNOSIS_DECL std::vector<key_value> settings_of(const contact_block::parameters& p);
QUADRANT_DIAGNOSIS_DECL std::vector<key_value> settings_of(const travel_block::parameters& p);

/// A feedforward of so much command as the keys of the kind have it; nothing where it has no such key.
QUADRANT_DIAGNOSIS_DECL std::vector<key_value> fed(const controller_kind& kind, const controller_description& c,
                                                   const feedforward_key& f, double amount);

/// The compensations of one axis that `causes` ask for, from the corrected plant `p` and its controller `c`.
class compensations_of {
public:
    compensations_of(const plant_model& p, const controller_description& c, double period,
                     std::vector<std::string> causes)
        : p_(p), c_(c), kind_(kind_of(c)), period_(period), causes_(std::move(causes)),
          volts_(1 / p.force_constant) {}

    std::vector<compensation> take();
    /// The causes for which the kind of the controller has no key.
    const std::vector<std::string>& without_key() const { return without_key_; }

private:
    std::vector<std::string> those(const std::vector<std::string>& names) const;
    std::vector<key_value> fed(const feedforward_key& f, double amount) const;
    bool already(const feedforward_key& f) const;
    std::vector<key_value> viscous() const { return fed(kind_.viscous, p_.friction.viscous_slope * volts_); }
    std::vector<key_value> coulomb() const { return fed(kind_.coulomb, p_.friction.coulomb * volts_); }

    void dry_friction();
    void along_the_position();
    void by_keys(const char* name, std::vector<std::string> effects, std::vector<key_value> keys);
    void by_block(const char* name, const char* effect, const char* block, compensated_forces forces,
                  std::vector<key_value> settings);
    /// What is there besides dry friction joined to each way of paying that.
    void together();
    static void join(compensation& sum, const compensation& each);

    inline static const std::vector<std::string> dry{"coulomb_friction", "stribeck_friction",
                                                     "presliding_friction"};
    const plant_model& p_;
    const controller_description& c_;
    const controller_kind& kind_;
    double period_;
    std::vector<std::string> causes_;
    double volts_;
    std::size_t ways_ = 0; ///< of paying dry friction: the first of out_
    std::vector<compensation> out_;
    std::vector<std::string> without_key_;
};

} // namespace detail
} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "compensation.ipp"
#endif
