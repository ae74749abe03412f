// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <openssl/evp.h>
#include <stdexcept>
#include <string>
#include <string_view>

namespace quadrant_gap {

/// SHA-256 of what is added, as 64 digits.
class sha256_sum {
public:
    sha256_sum() : state_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
        if (!state_ || EVP_DigestInit_ex(state_.get(), EVP_sha256(), nullptr) != 1)
            throw std::runtime_error("SHA-256 is not there");
    }
    void add(std::string_view text) { EVP_DigestUpdate(state_.get(), text.data(), text.size()); }
    std::string digits() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
        unsigned int length = 0;
        EVP_DigestFinal_ex(state_.get(), digest.data(), &length);
        std::string out;
        for (unsigned int k = 0; k < length; ++k) out += fmt::format("{:02x}", digest[k]);
        return out;
    }

private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> state_;
};

inline std::string sha256(std::string_view text) {
    sha256_sum sum;
    sum.add(text);
    return sum.digits();
}

/// Empty when the file cannot be read, or is no file.
inline std::string sha256_of_file(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return ""; // a FIFO would never end
    std::ifstream file(path, std::ios::binary);
    sha256_sum sum;
    std::array<char, 1 << 16> part;
    while (file.read(part.data(), part.size()) || file.gcount() > 0)
        sum.add({part.data(), static_cast<std::size_t>(file.gcount())});
    return file.is_open() && file.eof() ? sum.digits() : "";
}

} // namespace quadrant_gap
