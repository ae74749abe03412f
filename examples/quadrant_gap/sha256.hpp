// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <fmt/format.h>

#include <openssl/evp.h>
#include <stdexcept>
#include <string>
#include <string_view>

namespace quadrant_gap {

inline std::string sha256(std::string_view bytes) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("SHA-256 is not there");
    std::string out;
    for (unsigned int k = 0; k < length; ++k) out += fmt::format("{:02x}", digest[k]);
    return out;
}

} // namespace quadrant_gap
