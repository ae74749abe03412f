// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <dlfcn.h>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// LinuxCNC's own components as they are installed, loaded into this program and called one after another as a
/// HAL thread does. HAL itself is replaced by the few functions that components call: memory, pins and
/// functions by name.
namespace hal {

struct registry {
    std::map<std::string, volatile double**> pins;
    std::map<std::string, volatile double*> parameters;
    std::map<std::string, volatile bool**> bits;
    std::map<std::string, std::pair<void (*)(void*, long), void*>> functions;
    std::deque<double> cells; ///< signals; those of components are volatile
};
inline registry& known() {
    static registry all;
    return all;
}
inline std::string named(const char* format, std::va_list more) {
    char name[256];
    std::vsnprintf(name, sizeof name, format, more);
    return name;
}

constexpr const char* modules = "/usr/lib/linuxcnc/modules/";

/// `loadrt module count=n`.
inline void load(const char* module, const char* count, int n) {
    void* const so = dlopen((std::string(modules) + module + ".so").c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (so == nullptr) throw std::runtime_error(dlerror());
    auto* const wanted = static_cast<int**>(dlsym(so, (std::string("rtapi_info_address_") + count).c_str()));
    auto* const main = reinterpret_cast<int (*)()>(dlsym(so, "rtapi_app_main"));
    if (wanted == nullptr || main == nullptr) throw std::runtime_error(std::string(module) + ": no component");
    **wanted = n;
    if (main() != 0) throw std::runtime_error(std::string(module) + ": does not start");
}
template <class Of> auto& at(Of& all, const std::string& name) {
    const auto found = all.find(name);
    if (found == all.end()) throw std::runtime_error(name + ": no such pin");
    return found->second;
}
/// `net`: pins on one signal, which is given back.
inline volatile double* net(std::initializer_list<std::string> pins) {
    double* const signal = &known().cells.emplace_back(0.0);
    for (const std::string& each : pins) *at(known().pins, each) = signal;
    return signal;
}
/// `setp`.
inline void set(const std::string& name, double to) {
    if (const auto pin = known().pins.find(name); pin != known().pins.end())
        **pin->second = to;
    else
        *at(known().parameters, name) = to;
}
inline void set_bit(const std::string& name, bool to) { **at(known().bits, name) = to; }

/// `addf`, in order.
class thread {
public:
    void add(const std::string& function) { calls_.push_back(at(known().functions, function)); }
    void run(long period_ns) const {
        for (const auto& [call, argument] : calls_) call(argument, period_ns);
    }

private:
    std::vector<std::pair<void (*)(void*, long), void*>> calls_;
};

} // namespace hal

extern "C" { // what components import; found by the dynamic linker
int hal_init(const char*) { return 1; }
int hal_ready(int) { return 0; }
int hal_exit(int) { return 0; }
void* hal_malloc(long size) { return std::calloc(1, std::size_t(size)); }
int rtapi_get_msg_level() { return 0; }
int rtapi_set_msg_level(int) { return 0; }
void rtapi_print_msg(int, const char*, ...) {}
int rtapi_snprintf(char* to, unsigned long size, const char* format, ...) {
    std::va_list more;
    va_start(more, format);
    const int n = std::vsnprintf(to, size, format, more);
    va_end(more);
    return n;
}
int hal_pin_float_newf(int, volatile double** pin, int, const char* format, ...) {
    std::va_list more;
    va_start(more, format);
    hal::known().pins[hal::named(format, more)] = pin;
    va_end(more);
    *pin = &hal::known().cells.emplace_back(0.0);
    return 0;
}
int hal_param_float_newf(int, volatile double* parameter, int, const char* format, ...) {
    std::va_list more;
    va_start(more, format);
    hal::known().parameters[hal::named(format, more)] = parameter;
    va_end(more);
    return 0;
}
int hal_pin_bit_newf(int, volatile bool** pin, int, const char* format, ...) {
    std::va_list more;
    va_start(more, format);
    hal::known().bits[hal::named(format, more)] = pin;
    va_end(more);
    *pin = static_cast<volatile bool*>(std::calloc(1, 1));
    return 0;
}
int hal_pin_u32_newf(int, volatile unsigned** pin, int, const char*, ...) {
    *pin = static_cast<volatile unsigned*>(std::calloc(1, sizeof(unsigned)));
    return 0;
}
int hal_pin_s32_newf(int, volatile int** pin, int, const char*, ...) {
    *pin = static_cast<volatile int*>(std::calloc(1, sizeof(int)));
    return 0;
}
int hal_export_funct(const char* name, void (*call)(void*, long), void* argument, int, int, int) {
    hal::known().functions[name] = {call, argument};
    return 0;
}
}

namespace hal {

/// One axis of what LinuxCNC has of the loop: velocities by ddt and lowpass, biquad as notch, sum2 for gains
/// and sums, pid as PI, limit1. Friction, observer and memory are missing: there are no such components.
class axis {
public:
    struct gains {
        double position, velocity, integral, inertia, drag, limit, keep;
        double n0, n1, n2, d1, d2; ///< of the notch
    };
    axis(int number, const gains& g, thread& t) {
        const auto nth = [number](const char* name, int per_axis, int k) {
            return std::string(name) + "." + std::to_string(per_axis * number + k);
        };
        const std::string error = nth("sum2", 4, 0), demand = nth("sum2", 4, 1), ahead = nth("sum2", 4, 2),
                          total = nth("sum2", 4, 3), pid = nth("pid", 1, 0), limit = nth("limit1", 1, 0);
        const auto rate = [&](int k) { // wires and parameters of one velocity; its input and output
            const std::string ddt = nth("ddt", 2, k), lowpass = nth("lowpass", 2, k),
                              notch = nth("biquad", 2, k);
            net({ddt + ".out", lowpass + ".in"});
            net({lowpass + ".out", notch + ".in"});
            set(lowpass + ".gain", 1 - g.keep);
            for (const auto& [name, to] :
                 {std::pair{".n0", g.n0}, {".n1", g.n1}, {".n2", g.n2}, {".d1", g.d1}, {".d2", g.d2}})
                set(notch + name, to);
            set_bit(notch + ".enable", true);
            for (const std::string& each : {ddt, lowpass, notch}) t.add(each);
            return std::pair{ddt + ".in", notch + ".out"};
        };
        const auto [reference_in, reference_rate] = rate(0);
        const auto [measured_in, measured_rate] = rate(1);
        position_ = net({error + ".in0", reference_in});
        measured_ = net({error + ".in1", measured_in});
        set(error + ".gain1", -1);
        net({error + ".out", demand + ".in0"});
        set(demand + ".gain0", g.position);
        net({reference_rate, demand + ".in1"});
        net({demand + ".out", pid + ".command"});
        net({measured_rate, pid + ".feedback"});
        set(pid + ".Pgain", g.velocity);
        set(pid + ".Igain", g.integral);
        set(pid + ".maxoutput", g.limit);
        set_bit(pid + ".enable", true);
        acceleration_ = net({ahead + ".in0"});
        velocity_ = net({ahead + ".in1"});
        set(ahead + ".gain0", g.inertia);
        set(ahead + ".gain1", g.drag);
        net({pid + ".output", total + ".in0"});
        net({ahead + ".out", total + ".in1"});
        net({total + ".out", limit + ".in"});
        command_ = net({limit + ".out"});
        set(limit + ".min", -g.limit);
        set(limit + ".max", g.limit);
        for (const std::string& each : {error, demand, pid + ".do-pid-calcs", ahead, total, limit}) t.add(each);
    }
    void take(double position, double velocity, double acceleration, double measured) noexcept {
        *position_ = position;
        *velocity_ = velocity;
        *acceleration_ = acceleration;
        *measured_ = measured;
    }
    double command() const noexcept { return *command_; }

private:
    volatile double *position_, *velocity_, *acceleration_, *measured_, *command_;
};

/// What both axes need; throws when LinuxCNC is not there.
inline void load_for(int axes) {
    load("sum2", "count", 4 * axes);
    load("ddt", "count", 2 * axes);
    load("lowpass", "count", 2 * axes);
    load("biquad", "count", 2 * axes);
    load("pid", "num_chan", axes);
    load("limit1", "count", axes);
}

} // namespace hal
