// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/error.hpp>
#include <quadrant/block/taps.hpp>

#include <hal.h>
#include <rtapi.h>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>

/// HAL pins from lists: parameters from a list of fields, wires from the list of taps. Nothing is said twice.
namespace hal {

using quadrant::quantity;

/// One parameter of Settings: the name of its pin, its default, where it goes. In SI, as everything here that
/// is typed.
template <class Settings> struct parameter {
    const char* name;
    double standard;
    void (*set)(Settings&, double);
};
namespace detail {
template <class Unit, class Number> void assign(quantity<Unit, Number>& to, double x) {
    to = quantity<Unit, Number>::from_value(Number(x));
}
template <std::floating_point Number> void assign(Number& to, double x) { to = Number(x); }
/// What is no whole number becomes 0, which every block refuses that counts something.
inline void assign(std::size_t& to, double x) {
    to = x >= 0 && x <= 1e6 && x == std::floor(x) ? static_cast<std::size_t>(x) : 0;
}
} // namespace detail

/// field<p>("notch-centre", 330, [](p& s) { return &s.box.notch.centre; })
template <class Settings, class Where>
constexpr parameter<Settings> field(const char* name, double standard, Where) {
    return {name, standard, [](Settings& s, double x) { detail::assign(*Where{}(s), x); }};
}

/// HAL's names have no underscores.
inline std::string pin_name(const std::string& prefix, std::string name) {
    for (char& c : name)
        if (c == '_') c = '-';
    return prefix + "." + name;
}

/// HAL redirects a pin by writing the pointer to its value, which therefore lies in HAL's shared memory.
struct real_pin {
    hal_float_t** to = nullptr;
    double get() const noexcept { return **to; }
    void set(double x) const noexcept { **to = x; }
};
struct bit_pin {
    hal_bit_t** to = nullptr;
    bool get() const noexcept { return **to; }
    void set(bool x) const noexcept { **to = x; }
};

/// Makes the pins of one instance; the first failure stays in `error`, and nothing is made after it.
struct pin_maker {
    int component;
    std::string prefix;
    int error = 0;

    void make(real_pin& pin, hal_pin_dir_t direction, const std::string& name, double start = 0) {
        if (!room(pin.to)) return;
        error = hal_pin_float_newf(direction, pin.to, component, "%s", pin_name(prefix, name).c_str());
        if (error == 0) pin.set(start);
    }
    void make(bit_pin& pin, hal_pin_dir_t direction, const std::string& name, bool start = false) {
        if (!room(pin.to)) return;
        error = hal_pin_bit_newf(direction, pin.to, component, "%s", pin_name(prefix, name).c_str());
        if (error == 0) pin.set(start);
    }

private:
    template <class Pointer> bool room(Pointer*& pin) {
        if (error != 0) return false;
        pin = static_cast<Pointer*>(hal_malloc(sizeof(Pointer)));
        if (pin == nullptr) error = -1;
        return error == 0;
    }
};

/// Out pins for all wires of a loop, from its list of taps: NAME.wire.<tap>, in SI.
template <class Wires, std::size_t N> class wire_pins {
public:
    using taps = std::array<quadrant::tap_of<Wires, double>, N>;
    wire_pins(const taps& list, pin_maker& maker) : taps_(list) {
        for (std::size_t i = 0; i < N; ++i) maker.make(pins_[i], HAL_OUT, std::string("wire.") + taps_[i].name);
    }
    void show(const Wires& wires) const noexcept {
        for (std::size_t i = 0; i < N; ++i) pins_[i].set(taps_[i].read(wires));
    }

private:
    taps taps_;
    std::array<real_pin, N> pins_{};
};

} // namespace hal
