// SPDX-License-Identifier: BSL-1.0
// The diagnosis as WebAssembly: two functions that worker.js calls.
#include "session.hpp"

#include <emscripten.h>

EM_JS(void, quadrant_tell, (const char* line, double done),
      { postMessage({tell : UTF8ToString(line), done : done}); });

namespace {
quadrant_web::session& the_session() {
    static quadrant_web::session s(
        [](const std::string& line, double done) { quadrant_tell(line.c_str(), done); });
    return s;
}
} // namespace

extern "C" {

/// Keeps a file; the bytes are copied.
EMSCRIPTEN_KEEPALIVE void quadrant_put(const char* name, const char* bytes, std::size_t size,
                                       const char* sha256) {
    the_session().put(name, std::string(bytes, size), sha256);
}

/// Answers a request (JSON); the answer is valid until the next one.
EMSCRIPTEN_KEEPALIVE const char* quadrant_ask(const char* request) {
    static std::string answer;
    const auto json = nlohmann::json::parse(request, nullptr, false);
    answer = the_session().ask(json).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return answer.c_str();
}
}
