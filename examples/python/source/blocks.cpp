// SPDX-License-Identifier: BSL-1.0
// Long: one binding after the other, those of add_responses() too.
// Blocks for Python: plants, friction, the cascade, frequency responses, margins. Units stand in the names.
#include "parts.hpp"

#include <quadrant/analysis/frf.hpp>
#include <quadrant/analysis/margins.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <optional>
#include <variant>

namespace quadrant_python {
namespace {

using namespace quadrant;

template <class Quantity> Quantity si_value(double value) { return Quantity::from_value(value); }
duration seconds(double value) { return si_value<duration>(value); }
using position = quantity_of<signal::position>;
using velocity = quantity_of<signal::velocity>;
using force = quantity_of<signal::force>;
using volts = quantity_of<signal::voltage>;

/// y[k] = step(x[k]) for a whole array, while other threads of Python run.
template <class Step> array mapped(const array& x, const char* name, Step step) {
    const std::size_t rows = rows_of(x, name);
    array out(static_cast<py::ssize_t>(rows));
    const double* from = x.data();
    double* to = out.mutable_data();
    const py::gil_scoped_release others;
    for (std::size_t k = 0; k < rows; ++k) to[k] = step(from[k]);
    return out;
}

// --- friction ---

stribeck<>::parameters stribeck_of(double coulomb, std::optional<double> at_rest, double speed, double viscous,
                                   double shape) {
    return {.coulomb = si_value<force>(coulomb),
            .static_level = si_value<force>(at_rest.value_or(coulomb)),
            .stribeck_velocity = si_value<velocity>(speed),
            .viscous = si_value<gain_of<signal::force, signal::velocity>>(viscous),
            .shape = shape};
}

template <class Friction, class Class> void add_friction_calls(Class& c) {
    c.def(
         "step", [](Friction& f, double v) { return f(si_value<velocity>(v)).value(); },
         py::arg("velocity_m_per_s"))
        .def(
            "run",
            [](Friction& f, const array& v) {
                return mapped(v, "velocity_m_per_s",
                              [&](double x) { return f(si_value<velocity>(x)).value(); });
            },
            py::arg("velocity_m_per_s"))
        .def("reset", [](Friction& f) { f.reset(); })
        .def_property_readonly("faulted", [](const Friction& f) { return f.faulted(); });
}

void add_friction(py::module_& m) {
    py::class_<stribeck<>> curve(m, "Stribeck");
    curve.def(py::init([](double period, double coulomb, std::optional<double> at_rest, double speed,
                          double viscous, double shape) {
                  return stribeck<>(stribeck_of(coulomb, at_rest, speed, viscous, shape), seconds(period));
              }),
              py::kw_only(), py::arg("period_s"), py::arg("coulomb_N"), py::arg("static_N") = py::none(),
              py::arg("stribeck_velocity_m_per_s") = 0.01, py::arg("viscous_N_s_per_m") = 0.0,
              py::arg("shape") = 1.0);
    add_friction_calls<stribeck<>>(curve);

    py::class_<lugre<>> bristles(m, "LuGre");
    bristles.def(py::init([](double period, double coulomb, std::optional<double> at_rest, double speed,
                             double viscous, double shape, double stiffness, double damping) {
                     lugre<>::parameters p;
                     p.curve = stribeck_of(coulomb, at_rest, speed, viscous, shape);
                     p.stiffness = si_value<gain_rate_of<signal::force, signal::velocity>>(stiffness);
                     p.damping = si_value<gain_of<signal::force, signal::velocity>>(damping);
                     return lugre<>(p, seconds(period));
                 }),
                 py::kw_only(), py::arg("period_s"), py::arg("coulomb_N"), py::arg("static_N") = py::none(),
                 py::arg("stribeck_velocity_m_per_s") = 0.01, py::arg("viscous_N_s_per_m") = 0.0,
                 py::arg("shape") = 1.0, py::arg("stiffness_N_per_m"), py::arg("damping_N_s_per_m") = 0.0);
    add_friction_calls<lugre<>>(bristles);
}

// --- a plant ---

using motor = linear_motor<stribeck<>, 64>;

void add_plant(py::module_& m) {
    py::class_<motor>(m, "LinearMotor")
        .def(py::init([](double period, double mass, double force_constant, double viscous, double coulomb,
                         std::optional<double> at_rest, double speed, double delay, double limit, double dac,
                         double encoder, std::size_t substeps) {
                 motor::parameters p;
                 p.mass = si_value<quantity<si::mass>>(mass);
                 p.force_constant = si_value<gain_of<signal::force, signal::voltage>>(force_constant);
                 p.friction = stribeck_of(coulomb, at_rest, speed, viscous, 1);
                 p.delay = seconds(delay);
                 p.limit = si_value<volts>(limit);
                 p.dac_step = si_value<volts>(dac);
                 p.encoder_step = si_value<position>(encoder);
                 p.substeps = substeps;
                 return motor(p, seconds(period));
             }),
             py::kw_only(), py::arg("period_s"), py::arg("mass_kg"), py::arg("force_constant_N_per_V"),
             py::arg("viscous_N_s_per_m") = 0.0, py::arg("coulomb_N") = 0.0, py::arg("static_N") = py::none(),
             py::arg("stribeck_velocity_m_per_s") = 0.01, py::arg("delay_s") = 0.0, py::arg("limit_V") = 0.0,
             py::arg("dac_step_V") = 0.0, py::arg("encoder_step_m") = 0.0, py::arg("substeps") = 10)
        .def(
            "step",
            [](motor& p, double u, double external) {
                return p(si_value<volts>(u), si_value<force>(external)).value();
            },
            py::arg("command_V"), py::arg("external_N") = 0.0)
        .def(
            "run",
            [](motor& p, const array& u, const std::optional<array>& external) {
                if (external && rows_of(*external, "external_N") != rows_of(u, "command_V"))
                    throw py::value_error("external_N: must be as long as command_V");
                const double* pushed = external ? external->data() : nullptr;
                return mapped(u, "command_V", [&, k = std::size_t(0)](double x) mutable {
                    return p(si_value<volts>(x), si_value<force>(pushed ? pushed[k++] : 0)).value();
                });
            },
            py::arg("command_V"), py::arg("external_N") = py::none())
        .def("reset", [](motor& p) { p.reset(); })
        .def(
            "settle", [](motor& p, double x) { p.settle(si_value<position>(x)); }, py::arg("position_m"))
        .def_property_readonly("position_m", [](const motor& p) { return p.now().x.value(); })
        .def_property_readonly("velocity_m_per_s", [](const motor& p) { return p.now().v.value(); })
        .def_property_readonly("limited", [](const motor& p) { return p.limited(); })
        .def_property_readonly("faulted", [](const motor& p) { return p.faulted(); });
}

// --- the cascade, with a notch or without, as a machine file describes it ---

class any_cascade {
    using estimator = filtered_derivative<signal::position, signal::velocity>;
    using plain_boxes = cascade_p_pi_boxes<estimator>;
    using notched_boxes = cascade_p_pi_boxes<estimator, notch<signal::voltage>>;
    template <class Boxes> using loop = cascade<Boxes>;

    using either_loop = std::variant<loop<plain_boxes>, loop<notched_boxes>>;
    template <class Use> auto with(const Use& use) { return std::visit(use, loop_); }

public:
    struct settings {
        double period, position_gain, velocity_gain, velocity_integral, filter_Hz, velocity_feedforward,
            acceleration_feedforward, viscous_feedforward, coulomb_feedforward;
        std::optional<double> notch_Hz;
        double notch_width, limit, dac_step;
    };
    explicit any_cascade(const settings& s) : loop_(made(s)) {}

    double step(double reference, double measured) {
        return with(
            [&](auto& l) { return l(si_value<position>(reference), si_value<position>(measured)).value(); });
    }
    void reset() {
        with([](auto& l) { l.reset(); });
    }
    bool limited() {
        return with([](auto& l) { return l.limited(); });
    }
    bool faulted() {
        return with([](auto& l) { return l.faulted(); });
    }
    /// Every wire with its unit in the name.
    py::dict wires() {
        py::dict out;
        with([&](auto& l) {
            for_each_tap(l.wire, l.taps(), [&](const char* name, const char* unit, double value) {
                std::string key = std::string(name) + "_" + unit;
                for (std::size_t at; (at = key.find('/')) != key.npos;) key.replace(at, 1, "_per_");
                std::erase(key, '^');
                out[py::str(key)] = value;
            });
        });
        return out;
    }

private:
    template <class Boxes> static loop<Boxes> make(const settings& s, decltype(Boxes::parameters::notch) n) {
        typename Boxes::parameters p{
            .position_gain = si_value<gain_of<signal::velocity, signal::position>>(s.position_gain),
            .velocity_gain = si_value<gain_of<signal::voltage, signal::velocity>>(s.velocity_gain),
            .velocity_integral = si_value<gain_rate_of<signal::voltage, signal::velocity>>(s.velocity_integral),
            .estimator = {.corner = si_value<frequency>(s.filter_Hz)},
            .velocity_feedforward = s.velocity_feedforward,
            .acceleration_feedforward =
                si_value<gain_of<signal::voltage, signal::acceleration>>(s.acceleration_feedforward),
            .viscous_feedforward = si_value<gain_of<signal::voltage, signal::velocity>>(s.viscous_feedforward),
            .coulomb_feedforward = si_value<volts>(s.coulomb_feedforward),
            .notch = n,
            .limit = si_value<volts>(s.limit),
            .dac_step = si_value<volts>(s.dac_step)};
        return {.box = {p, seconds(s.period)}};
    }
    static either_loop made(const settings& s) {
        if (!s.notch_Hz) return make<plain_boxes>(s, {});
        return make<notched_boxes>(s, {.centre = si_value<frequency>(*s.notch_Hz), .width = s.notch_width});
    }
    either_loop loop_;
};

py::dict closed_loop(any_cascade& controller, motor& plant, const array& reference,
                     const std::optional<array>& external) {
    const std::size_t rows = rows_of(reference, "reference_m");
    if (external && rows_of(*external, "external_N") != rows)
        throw py::value_error("external_N: must be as long as reference_m");
    array read(static_cast<py::ssize_t>(rows)), commanded(static_cast<py::ssize_t>(rows));
    const double *asked = reference.data(), *pushed = external ? external->data() : nullptr;
    double *y = read.mutable_data(), *u = commanded.mutable_data();
    {
        const py::gil_scoped_release others;
        double reading = plant.now().x.value();
        for (std::size_t k = 0; k < rows; ++k) {
            y[k] = reading; // a row has the reading that the controller had, and what it made of it
            u[k] = controller.step(asked[k], reading);
            reading = plant(si_value<volts>(u[k]), si_value<force>(pushed ? pushed[k] : 0)).value();
        }
    }
    py::dict out;
    out["position_m"] = read;
    out["command_V"] = commanded;
    return out;
}

void add_cascade(py::module_& m) {
    py::class_<any_cascade>(m, "Cascade")
        .def(py::init([](double period, double kp, double kv, double ki, double filter, double limit,
                         double vff, double aff, double bff, double cff, std::optional<double> notch,
                         double width, double dac) {
                 return any_cascade({period, kp, kv, ki, filter, vff, aff, bff, cff, notch, width, limit, dac});
             }),
             py::kw_only(), py::arg("period_s"), py::arg("position_gain_per_s"),
             py::arg("velocity_gain_V_s_per_m"), py::arg("velocity_integral_V_per_m") = 0.0,
             py::arg("velocity_filter_Hz"), py::arg("limit_V"), py::arg("velocity_feedforward") = 1.0,
             py::arg("acceleration_feedforward_V_s2_per_m") = 0.0,
             py::arg("viscous_feedforward_V_s_per_m") = 0.0, py::arg("coulomb_feedforward_V") = 0.0,
             py::arg("notch_Hz") = py::none(), py::arg("notch_width") = 0.1, py::arg("dac_step_V") = 0.0)
        .def("step", &any_cascade::step, py::arg("reference_m"), py::arg("measured_m"))
        .def(
            "run",
            [](any_cascade& c, const array& reference, const array& measured) {
                if (rows_of(measured, "measured_m") != rows_of(reference, "reference_m"))
                    throw py::value_error("measured_m: must be as long as reference_m");
                const double* y = measured.data();
                return mapped(reference, "reference_m",
                              [&, k = std::size_t(0)](double r) mutable { return c.step(r, y[k++]); });
            },
            py::arg("reference_m"), py::arg("measured_m"))
        .def("reset", &any_cascade::reset)
        .def("wires", &any_cascade::wires)
        .def_property_readonly("limited", &any_cascade::limited)
        .def_property_readonly("faulted", &any_cascade::faulted);
    m.def("closed_loop", &closed_loop, py::arg("controller"), py::arg("plant"), py::arg("reference_m"),
          py::arg("external_N") = py::none());
}

// --- responses ---

using complex_array = py::array_t<std::complex<double>, py::array::c_style | py::array::forcecast>;

void add_responses(py::module_& m) {
    m.def(
        "frf",
        [](const array& x, const array& y, double period, std::size_t samples, double overlap,
           const std::string& shape, const std::string& trend) {
            const std::size_t rows = rows_of(x, "input");
            if (rows_of(y, "output") != rows) throw py::value_error("output: must be as long as input");
            using measured = analysis::frf<signal::voltage, signal::position>; // names of the wires alone
            measured::parameters p{.samples = samples, .overlap = overlap};
            if (shape != "hann" && shape != "none") throw py::value_error("window: must be hann or none");
            p.shape = shape == "hann" ? analysis::window::hann : analysis::window::none;
            if (trend != "keep" && trend != "mean" && trend != "line")
                throw py::value_error("remove: must be keep, mean or line");
            p.remove = trend == "keep"   ? analysis::trend::keep
                       : trend == "mean" ? analysis::trend::mean
                                         : analysis::trend::line;
            const double *in = x.data(), *out = y.data();
            analysis::measured_frf found;
            {
                const py::gil_scoped_release others;
                measured f(p, seconds(period));
                for (std::size_t k = 0; k < rows; ++k)
                    f.add(si_value<volts>(in[k]), si_value<position>(out[k]));
                found = f.result();
            }
            const auto n = static_cast<py::ssize_t>(found.lines.size());
            array f(n), coherence(n), spread(n);
            complex_array value(n);
            for (py::ssize_t k = 0; k < n; ++k) {
                const auto& line = found.lines[static_cast<std::size_t>(k)];
                f.mutable_at(k) = line.f.value();
                value.mutable_at(k) = line.value;
                coherence.mutable_at(k) = line.coherence;
                spread.mutable_at(k) = line.spread;
            }
            return py::make_tuple(f, value, coherence, spread, found.averages);
        },
        py::arg("input"), py::arg("output"), py::kw_only(), py::arg("period_s"), py::arg("samples") = 2048,
        py::arg("overlap") = 0.5, py::arg("window") = "hann", py::arg("remove") = "mean");
    m.def(
        "margins",
        [](const array& f, const complex_array& open_loop) {
            const std::size_t rows = rows_of(f, "frequency_Hz");
            if (open_loop.ndim() != 1 || static_cast<std::size_t>(open_loop.shape(0)) != rows)
                throw py::value_error("open_loop: must be as long as frequency_Hz");
            std::vector<frequency> lines(rows);
            std::vector<analysis::complex> values(rows);
            for (std::size_t k = 0; k < rows; ++k) {
                lines[k] = si_value<frequency>(f.data()[k]);
                values[k] = open_loop.data()[k];
            }
            const analysis::tabulated_response loop(std::move(lines), std::move(values));
            const auto found = analysis::margins(loop, loop.all());
            const auto listed = [](const std::vector<analysis::margin>& all) {
                std::vector<std::pair<double, double>> out;
                for (const auto& each : all) out.emplace_back(each.value, each.at.value());
                return out;
            };
            return std::tuple(listed(found.gain_crossings), listed(found.phase_crossings),
                              std::pair(found.modulus.value, found.modulus.at.value()), found.text());
        },
        py::arg("frequency_Hz"), py::arg("open_loop"));
}

} // namespace

void add_blocks(py::module_& m) {
    add_friction(m);
    add_plant(m);
    add_cascade(m);
    add_responses(m);
}

} // namespace quadrant_python
