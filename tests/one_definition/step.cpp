// SPDX-License-Identifier: BSL-1.0
// Compiled once for every instruction set, with -Drun=run_NAME.
#include "run.hpp"

#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/base/make.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/proportional_integral.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/memory/fractional_delay.hpp>
#include <quadrant/observer/disturbance_observer.hpp>

using namespace quadrant;
using namespace quadrant::literals;
using machines = lanes<8>;

result run() {
    machines number;
    for (std::size_t i = 0; i < 8; ++i) number.set(i, 1 + 0.1 * double(i));
    const duration T = 500_us;
    using hertz = quantity<hertz_unit, machines>;
    notch<signal::voltage, machines> resonance({hertz::from_value(300 * number), 0.2 * number}, T);
    butterworth<signal::voltage, machines> smooth({hertz::from_value(200 * number)}, T);
    proportional_integral<signal::voltage, signal::voltage, integral_clamp, machines> loop(
        {gain_of<signal::voltage, signal::voltage, machines>::from_value(2 * number),
         gain_rate_of<signal::voltage, signal::voltage, machines>::from_value(30 * number),
         quantity_of<signal::voltage, machines>::from_value(5 * number)},
        T);
    fractional_delay<signal::voltage, 7, 3, machines> late(
        {quantity<si::time, machines>::from_value(7e-4 * number)}, T);
    disturbance_observer<signal::voltage, signal::voltage, 2, 0, 2, 0, machines> observer(
        {hertz::from_value(60 * number), {{0.63 * number}, {machines(0), 2.5 * number, machines(1)}}}, T);

    machines through, curved;
    for (int k = 0; k < 2000; ++k) {
        const machines x = number * double(k % 37 - 18);
        const auto u = loop(late(smooth(resonance(quantity_of<signal::voltage, machines>::from_value(x)))));
        through += u.value() + observer(u).value();
        curved += exp(x * -0.1) * sin(x);
    }
    result out{};
    out.through = through.each();
    out.curved = curved.each();
    machines wrong = 300 * number;
    wrong.set(5, 4000);
    const auto refused = make<notch<signal::force, machines>>({hertz::from_value(wrong), 0.2 * number}, T);
    out.refused = refused.why();
    return out;
}
