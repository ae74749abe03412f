// SPDX-License-Identifier: BSL-1.0
// How far a diagnosis is: a share that never falls and ends at one, and what is said of it.
#include "page/progress.hpp"

#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using namespace quadrant::diagnosis;

namespace {

struct heard {
    std::vector<std::string> lines;
    std::vector<double> shares;
    progress hearer() {
        return [this](const std::string& line, double done) {
            lines.push_back(line);
            shares.push_back(done);
        };
    }
    /// How many different shares were heard.
    std::size_t steps() const { return std::set<double>(shares.begin(), shares.end()).size(); }
    /// How far it jumps at most.
    double largest_jump() const {
        double most = shares.front();
        for (std::size_t i = 1; i < shares.size(); ++i) most = std::max(most, shares[i] - shares[i - 1]);
        return most;
    }
    bool never_falls() const { return std::is_sorted(shares.begin(), shares.end()); }
};

const std::string data = QUADRANT_SOURCE_DIR "/examples/data/";
rules one_thread() {
    rules r = fast_rules();
    r.threads = 1;
    return r;
}

} // namespace

TEST_CASE("progress: a part of a part is where it belongs, and no share falls") {
    heard h;
    const progress whole = h.hearer();
    whole("begins");
    const progress half = whole.part(0.5, 1), quarter = half.part(0, 0.5);
    quarter("in the third quarter", 0.5);
    quarter("at its end", 7); // no part has more than all of it
    whole("told late", 0.1);
    half("goes on");
    whole("done", 1);
    CHECK(h.shares == std::vector<double>{0, 0.625, 0.75, 0.75, 0.75, 1});
}

TEST_CASE("progress: lines of a part can be named, and count for the whole") {
    heard h;
    const progress whole = h.hearer();
    whole.part(0, 0.4, "first: ").part(0.5, 1)("tried", 1);
    whole.part(0.4, 1, "second: ")("tried", 0);
    CHECK(h.lines == std::vector<std::string>{"first: tried", "second: tried"});
    CHECK(h.shares == std::vector<double>{0.4, 0.4});
}

TEST_CASE("progress: a function of a line alone hears the lines; without one nothing is heard") {
    std::vector<std::string> lines;
    const progress some = [&](const std::string& line) { lines.push_back(line); };
    some.part(0, 0.5)("one", 1);
    CHECK(lines == std::vector<std::string>{"one"});
    const progress none;
    none.part(0, 0.5, "first: ")("nobody hears it", 1);
}

TEST_CASE("progress: a diagnosis says how far it is in small steps, never goes back, and ends with all of it") {
    const auto machine = read_machine(std::filesystem::path(data + "machine.json"));
    const auto log = read_log(std::filesystem::path(data + "log.csv"));
    heard h;
    diagnose(machine, log, nullptr, h.hearer(), one_thread());
    REQUIRE(!h.shares.empty());
    CHECK(h.never_falls());
    CHECK(h.shares.back() == 1);
    CHECK(h.steps() > 10);
    CHECK(h.largest_jump() < 0.4);
    CHECK(std::any_of(h.lines.begin(), h.lines.end(), [](const std::string& line) {
        return line.starts_with("x: trying ") && line.find("Coulomb friction") != line.npos;
    }));
}

TEST_CASE("progress: what a listener throws ends the diagnosis") {
    const auto machine = read_machine(std::filesystem::path(data + "machine.json"));
    const auto log = read_log(std::filesystem::path(data + "log.csv"));
    int lines = 0;
    const progress enough = [&](const std::string&) {
        if (++lines == 5) throw std::runtime_error("enough");
    };
    CHECK_THROWS_WITH(diagnose(machine, log, nullptr, enough, one_thread()), "enough");
    CHECK(lines == 5);
}

TEST_CASE("progress: per cent and the time that is left, from the share that is done") {
    using quadrant_page::in_per_cent;
    CHECK(in_per_cent(0, 0) == "  0 %");
    CHECK(in_per_cent(0.04, 10) == "  4 %"); // too little to tell the rest from
    CHECK(in_per_cent(0.25, 4) == " 25 %, about 12 s left");
    CHECK(in_per_cent(0.5, 600) == " 50 %, about 10 min left");
    CHECK(in_per_cent(0.9999, 100) == " 99 %, about 0 s left");
    CHECK(in_per_cent(1, 100) == "100 %");
}
