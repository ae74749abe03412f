// SPDX-License-Identifier: BSL-1.0
// usage: pid_table PID_SO     Loads LinuxCNC's component pid without a real-time system and prints what it
// answers: for each case a line with its period in nanoseconds and its pins, then a line with command, feedback
// and output for each sample, every number exact (%a). The few calls of HAL that the component makes are
// answered here.
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <map>
#include <string>
#include <vector>

namespace {

std::map<std::string, volatile double*> reals;
std::map<std::string, volatile bool*> bits;
void (*calculate)(void*, long) = nullptr;
void* its_argument = nullptr;

std::string formatted(const char* format, va_list arguments) {
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    return text;
}
template <class T> int pin(std::map<std::string, volatile T*>& pins, volatile T** place, std::string name) {
    *place = static_cast<volatile T*>(std::calloc(1, 8));
    pins[name] = *place;
    return 0;
}

} // namespace

extern "C" {
int hal_init(const char*) { return 1; }
int hal_exit(int) { return 0; }
int hal_ready(int) { return 0; }
void* hal_malloc(long size) { return std::calloc(1, static_cast<std::size_t>(size)); }
int hal_pin_float_newf(int, volatile double** place, int, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const std::string name = formatted(format, arguments);
    va_end(arguments);
    return pin(reals, place, name);
}
int hal_pin_bit_newf(int, volatile bool** place, int, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const std::string name = formatted(format, arguments);
    va_end(arguments);
    return pin(bits, place, name);
}
int hal_pin_s32_newf(int, volatile std::int32_t** place, int, const char*, ...) {
    *place = static_cast<volatile std::int32_t*>(std::calloc(1, 8));
    return 0;
}
int hal_pin_u32_newf(int, volatile std::uint32_t** place, int, const char*, ...) {
    *place = static_cast<volatile std::uint32_t*>(std::calloc(1, 8));
    return 0;
}
int hal_export_funct(const char*, void (*function)(void*, long), void* argument, int, int, int) {
    if (!calculate) calculate = function, its_argument = argument; // of the first channel
    return 0;
}
int rtapi_get_msg_level() { return 0; }
int rtapi_set_msg_level(int) { return 0; }
void rtapi_print_msg(int, const char*, ...) {}
int rtapi_snprintf(char* text, unsigned long size, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int n = std::vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return n;
}
}

namespace {

struct setting {
    const char* pin;
    double value;
};
struct one_case {
    long period;
    bool previous_target;
    std::vector<setting> pins;
};

const std::vector<one_case> cases{
    {1000000, false, {{"Pgain", 4.15}, {"Igain", 33}, {"Dgain", 0.035}, {"FF1", 0.00022}, {"FF2", 0.00016}}},
    {1000000, true, {{"Pgain", 100}, {"Igain", 0.3}, {"Dgain", 0.7}, {"FF1", 1}, {"bias", 0.017}}},
    {250000, true, {{"Pgain", 7}, {"FF0", 0.3}, {"FF1", 0.021}, {"FF2", 0.0013}, {"FF3", 0.00001}}},
    {500000, false, {{"Pgain", 50}, {"Igain", 900}, {"Dgain", 0.4}, {"deadband", 0.01}, {"maxoutput", 2}}},
    {500000,
     false,
     {{"Pgain", 50}, {"Igain", 900}, {"maxerror", 0.02}, {"maxerrorI", 0.0001}, {"maxoutput", 3}}},
    {333333, true, {{"Pgain", 3}, {"Dgain", 0.4}, {"maxerrorD", 1.5}, {"FF1", 0.1}, {"maxcmdD", 8}}},
    {999999, false, {{"Pgain", 3}, {"FF2", 0.01}, {"maxcmdDD", 300}, {"FF3", 0.0001}, {"maxcmdDDD", 50000}}},
    {1000000,
     true,
     {{"Pgain", -2}, {"Igain", -10}, {"Dgain", -0.1}, {"FF1", -0.1}, {"bias", -0.2}, {"maxoutput", 0.5}}},
};

} // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: pid_table PID_SO\n");
        return 2;
    }
    std::uint64_t random = 20081121;
    const auto uniform = [&] {
        random = random * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(random >> 11) * 0x1p-53 - 0.5;
    };
    for (const one_case& c : cases) {
        void* const component = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
        const auto start =
            component ? reinterpret_cast<int (*)()>(dlsym(component, "rtapi_app_main")) : nullptr;
        if (!start || start() != 0 || !calculate) {
            std::fprintf(stderr, "%s\n", component ? "the component does not start" : dlerror());
            return 1;
        }
        const auto real = [](const char* name) -> volatile double& {
            return *reals.at(std::string("pid.0.") + name);
        };
        *bits.at("pid.0.enable") = true;
        *bits.at("pid.0.error-previous-target") = c.previous_target;
        std::printf("case %ld error-previous-target %d", c.period, c.previous_target ? 1 : 0);
        for (const setting& s : c.pins) {
            real(s.pin) = s.value;
            std::printf(" %s %a", s.pin, s.value);
        }
        std::printf("\n");
        double command = 0, velocity = 0, behind = 0;
        for (int k = 0; k < 60; ++k) {
            velocity += 0.4 * uniform() + (k < 20 ? 0.1 : k < 40 ? -0.1 : 0);
            command += k < 10 ? 0 : 0.01 * velocity;
            behind = 0.8 * behind + 0.02 * uniform();
            const double feedback = command - behind;
            real("command") = command;
            real("feedback") = feedback;
            calculate(its_argument, c.period);
            std::printf("%a %a %a\n", command, feedback, static_cast<double>(real("output")));
        }
        reals.clear(), bits.clear(), calculate = nullptr;
        dlclose(component);
    }
}
