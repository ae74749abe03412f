// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

QUADRANT_DIAGNOSIS_DECL void set_keys(controller_description& c, const std::vector<key_value>& keys) {
    for (const key_value& k : keys) c.values[k.key] = k.values;
}

QUADRANT_DIAGNOSIS_DECL std::vector<key_value> settings_of(const level_block::parameters& p) {
    return {{"coulomb_N", {p.law.coulomb.value()}},
            {"static_N", {p.law.static_level.value()}},
            {"stribeck_velocity_m_per_s", {p.law.stribeck_velocity.value()}},
            {"force_constant", {p.force_constant.value()}},
            {"width_m_per_s", {p.width.value()}}};
}

QUADRANT_DIAGNOSIS_DECL std::vector<key_value> settings_of(const contact_block::parameters& p) {
    key_value weights{"weights", {}}, stiffness{"stiffness_per_m", {}};
    for (std::size_t i = 0; i < p.weights.size(); ++i) {
        weights.values.push_back(p.weights[i]);
        stiffness.values.push_back(p.stiffness[i].value());
    }
    return {{"coulomb", {p.curve.coulomb.value()}},
            {"static_level", {p.curve.static_level.value()}},
            {"stribeck_velocity_m_per_s", {p.curve.stribeck_velocity.value()}},
            weights,
            stiffness,
            {"attraction_per_s", {p.attraction.value()}}};
}

QUADRANT_DIAGNOSIS_DECL std::vector<key_value> settings_of(const travel_block::parameters& p) {
    key_value amplitude{"amplitude", {}}, phase{"phase_rad", {}};
    for (const auto& h : p.harmonics) {
        amplitude.values.push_back(h.amplitude.value());
        phase.values.push_back(h.phase);
    }
    while (amplitude.values.size() > 1 && amplitude.values.back() == 0) {
        amplitude.values.pop_back();
        phase.values.pop_back();
    }
    return {{"pitch_m", {p.pitch.value()}}, amplitude, phase};
}

QUADRANT_DIAGNOSIS_DECL std::vector<key_value> fed(const controller_kind& kind, const controller_description& c,
                                                   const feedforward_key& f, double amount) {
    if (f.key.empty()) return {};
    return {{std::string(f.key), {f.over.empty() ? amount : amount / given_values(kind, c)[f.over]}}};
}

QUADRANT_DIAGNOSIS_DECL std::vector<compensation> compensations_of::take() {
    dry_friction();
    if (auto own = those({"viscous_friction"}); !own.empty()) by_keys("viscous_feedforward", own, viscous());
    if (auto own = those({"mass", "force_constant"}); !own.empty()) {
        auto keys = fed(kind_.acceleration, p_.mass * volts_);
        const auto add = [&](const std::vector<key_value>& more) {
            keys.insert(keys.end(), more.begin(), more.end());
        };
        const bool gain = own.back() == "force_constant"; // then what is paid already is paid in wrong coin
        if (gain && already(kind_.viscous)) add(viscous());
        if (gain && already(kind_.coulomb) && those(dry).empty()) add(coulomb());
        by_keys("acceleration_feedforward", own, keys);
    }
    by_block("friction by direction", "asymmetric_friction", "constant and proportional", {.asymmetry = true},
             {{"constant", {p_.friction.coulomb_asymmetry * p_.friction.coulomb * volts_}},
              {"per_speed_s_per_m", {p_.friction.viscous_asymmetry * p_.friction.viscous_slope * volts_}}});
    if (p_.friction.along.count > 0)
        by_block("friction along the travel", "position_dependent_friction",
                 "cogging_harmonics times the sign of the motion", {.along = true},
                 settings_of(travel_parameters(p_.friction.along, p_.friction.coulomb * volts_)));
    if (p_.cogging.count > 0)
        by_block("cogging feedforward", "cogging", "cogging_harmonics", {.cogging = true},
                 settings_of(cogging_parameters(p_)));
    along_the_position();
    together();
    return std::move(out_);
}

QUADRANT_DIAGNOSIS_DECL void compensations_of::along_the_position() {
    const auto bias = fed(kind_.constant, -p_.constant_force * volts_);
    const auto slope = fed(kind_.position, p_.spring * volts_);
    if (bias.empty())
        by_block("constant command", "constant_force", "constant", {.constant = true},
                 {{"constant", {-p_.constant_force * volts_}}});
    else if (auto own = those({"constant_force"}); !own.empty())
        by_keys("constant command", own, bias);
    if (bias.empty() || slope.empty()) {
        by_block("command along the travel", "position_spring", "proportional",
                 {.constant = true, .spring = true},
                 {{"per_position_per_m", {p_.spring * volts_}}, {"constant", {-p_.constant_force * volts_}}});
    } else if (auto own = those({"position_spring"}); !own.empty()) {
        auto both = slope;
        both.insert(both.end(), bias.begin(), bias.end());
        by_keys("command along the travel", own, both);
    }
}

QUADRANT_DIAGNOSIS_DECL std::vector<std::string>
compensations_of::those(const std::vector<std::string>& names) const {
    std::vector<std::string> out;
    for (const auto& name : names)
        if (std::find(causes_.begin(), causes_.end(), name) != causes_.end()) out.push_back(name);
    return out;
}

QUADRANT_DIAGNOSIS_DECL std::vector<key_value> compensations_of::fed(const feedforward_key& f,
                                                                     double amount) const {
    return detail::fed(kind_, c_, f, amount);
}

QUADRANT_DIAGNOSIS_DECL bool compensations_of::already(const feedforward_key& f) const {
    return !f.key.empty() && given_values(kind_, c_)[f.key] != 0;
}

QUADRANT_DIAGNOSIS_DECL void compensations_of::dry_friction() {
    const auto own = those(dry);
    if (own.empty() || !(p_.friction.coulomb + p_.friction.excess > 0)) return;
    const auto instead = fed(kind_.coulomb, 0);
    if (!instead.empty()) by_keys("coulomb_feedforward", own, coulomb());
    if (p_.friction.excess > 0 || instead.empty())
        out_.push_back({.name = "friction_feedforward",
                        .effects = own,
                        .block = "friction_feedforward<stribeck>",
                        .settings = settings_of(level_parameters(p_)),
                        .keys = instead,
                        .forces = {.level = true}});
    if (p_.friction.contact.elements > 1)
        out_.push_back({.name = "presliding feedforward",
                        .effects = own,
                        .block = "maxwell_slip",
                        .settings = settings_of(contact_parameters(p_, period_)),
                        .keys = instead,
                        .forces = {.contact = true}});
    ways_ = out_.size();
}

QUADRANT_DIAGNOSIS_DECL void compensations_of::by_keys(const char* name, std::vector<std::string> effects,
                                                       std::vector<key_value> keys) {
    if (keys.empty()) {
        without_key_.insert(without_key_.end(), effects.begin(), effects.end());
        return;
    }
    out_.push_back({.name = name, .effects = std::move(effects), .keys = std::move(keys)});
}

QUADRANT_DIAGNOSIS_DECL void compensations_of::by_block(const char* name, const char* effect, const char* block,
                                                        compensated_forces forces,
                                                        std::vector<key_value> settings) {
    if (auto own = those({effect}); !own.empty())
        out_.push_back({.name = name,
                        .effects = std::move(own),
                        .block = block,
                        .settings = std::move(settings),
                        .forces = forces});
}

QUADRANT_DIAGNOSIS_DECL void compensations_of::together() {
    const std::size_t singles = out_.size();
    if (singles - ways_ + (ways_ > 0 ? 1 : 0) < 2) return;
    for (std::size_t way = 0; way < std::max<std::size_t>(1, ways_); ++way) {
        compensation sum{.name = ways_ > 0 ? out_[way].name + " and the rest" : "all of them"};
        if (ways_ > 0) join(sum, out_[way]);
        for (std::size_t i = ways_; i < singles; ++i) join(sum, out_[i]);
        out_.push_back(std::move(sum));
    }
}

QUADRANT_DIAGNOSIS_DECL void compensations_of::join(compensation& sum, const compensation& each) {
    sum.effects.insert(sum.effects.end(), each.effects.begin(), each.effects.end());
    sum.keys.insert(sum.keys.end(), each.keys.begin(), each.keys.end());
    if (!each.block.empty()) sum.block += (sum.block.empty() ? "" : ", ") + each.block;
    compensated_forces& f = sum.forces;
    const compensated_forces& g = each.forces;
    f = {f.level || g.level,     f.contact || g.contact,   f.asymmetry || g.asymmetry, f.along || g.along,
         f.cogging || g.cogging, f.constant || g.constant, f.spring || g.spring};
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
