// SPDX-License-Identifier: BSL-1.0
// As much of LinuxCNC's rtapi.h and hal.h as the components use: names and signatures alike, pins in a map.
#pragma once
#include <cstdarg>
#include <cstdio>
#include <deque>
#include <map>
#include <new>
#include <string>

#define MODULE_LICENSE(s)
#define MODULE_DESCRIPTION(s)
#define RTAPI_MP_INT(variable, text)

using hal_float_t = volatile double;
using hal_bit_t = volatile bool;
enum hal_pin_dir_t { HAL_IN = 16, HAL_OUT = 32 };
constexpr int HAL_NAME_LEN = 47;
enum msg_level_t { RTAPI_MSG_ERR = 1 };

namespace stub {
inline std::map<std::string, hal_float_t*> reals;
inline std::map<std::string, hal_bit_t*> bits;
struct function {
    void (*call)(void*, long);
    void* self;
};
inline std::map<std::string, function> functions;
inline std::string said;
inline std::string written(const char* format, std::va_list list) {
    char text[512];
    std::vsnprintf(text, sizeof text, format, list);
    return text;
}
inline void* room() {
    static std::deque<double> memory;
    return &memory.emplace_back();
}
template <class Data> int new_pin(std::map<std::string, Data*>& all, Data** to, const std::string& name) {
    if (name.size() > HAL_NAME_LEN || all.count(name) != 0) return -1;
    *to = all[name] = new (room()) Data{};
    return 0;
}
} // namespace stub

[[gnu::format(printf, 2, 3)]] inline void rtapi_print_msg(msg_level_t, const char* format, ...) {
    std::va_list list;
    va_start(list, format);
    stub::said = stub::written(format, list);
    va_end(list);
}
[[gnu::format(printf, 3, 4)]] inline int rtapi_snprintf(char* out, unsigned long size, const char* format,
                                                        ...) {
    std::va_list list;
    va_start(list, format);
    const int length = std::vsnprintf(out, size, format, list);
    va_end(list);
    return length;
}
inline int hal_init(const char*) { return 1; }
inline int hal_ready(int) { return 0; }
inline int hal_exit(int) { return 0; }
inline void* hal_malloc(long size) { return size <= 8 ? stub::room() : nullptr; }
[[gnu::format(printf, 4, 5)]] inline int hal_pin_float_newf(hal_pin_dir_t, hal_float_t** pin, int,
                                                            const char* format, ...) {
    std::va_list list;
    va_start(list, format);
    const std::string name = stub::written(format, list);
    va_end(list);
    return stub::new_pin(stub::reals, pin, name);
}
[[gnu::format(printf, 4, 5)]] inline int hal_pin_bit_newf(hal_pin_dir_t, hal_bit_t** pin, int,
                                                          const char* format, ...) {
    std::va_list list;
    va_start(list, format);
    const std::string name = stub::written(format, list);
    va_end(list);
    return stub::new_pin(stub::bits, pin, name);
}
inline int hal_export_funct(const char* name, void (*call)(void*, long), void* self, int, int, int) {
    stub::functions[name] = {call, self};
    return 0;
}
