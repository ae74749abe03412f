// SPDX-License-Identifier: BSL-1.0
// usage: source_logs list                      the names of all cases
//        source_logs make FOLDER NAME...       FOLDER/NAME/log.csv and machine.json of each
//        source_logs causes FOLDER NAME...  (none: all) FOLDER/NAME/log.csv, holdout.csv and machine.json of
//                                      each candidate cause; JSON: what it is, and the figure that it leaves
//        source_logs reversals MACHINE LOG     JSON: following error at the reversals, logged and simulated
#include "causes.hpp"
#include "milling_table.hpp"
#include "reversals.hpp"
#include "stage.hpp"
#include "virtual_cnc.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>

int main(int count, char** words) try {
    std::vector<sources::log_case> cases;
    sources::milling_table::add(cases);
    sources::virtual_cnc::add(cases);
    sources::precision_stage::add(cases);
    const std::string verb = count > 1 ? words[1] : "";
    if (verb == "list" && count == 2) {
        for (const auto& c : cases) std::puts(c.name.c_str());
    } else if (verb == "reversals" && count == 4) {
        std::puts(sources::reversals(words[2], words[3]).dump(1).c_str());
    } else if (verb == "make" && count > 3) {
        for (int k = 3; k < count; ++k) {
            const auto found =
                std::find_if(cases.begin(), cases.end(), [&](const auto& c) { return c.name == words[k]; });
            if (found == cases.end()) throw std::runtime_error(std::string("no case ") + words[k]);
            write(found->make(), std::filesystem::path(words[2]) / found->name);
        }
    } else if (verb == "causes" && count >= 3) {
        nlohmann::ordered_json told = nlohmann::ordered_json::array();
        for (const auto& c : sources::causes::all()) {
            if (count > 3 && std::find(words + 3, words + count, c.name) == words + count) continue;
            const auto made = c.make();
            const auto folder = std::filesystem::path(words[2]) / c.name;
            write(sources::written_case{made.log, made.machine}, folder);
            write(made.holdout, folder / "holdout.csv");
            told.push_back({{"name", c.name},
                            {"puzzle", c.puzzle},
                            {"words", c.words},
                            {"truth", c.truth},
                            {"seen", made.seen}});
        }
        std::puts(told.dump(1).c_str());
    } else
        throw std::runtime_error("usage: source_logs list | make FOLDER NAME... | causes FOLDER [NAME...] | "
                                 "reversals MACHINE LOG");
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
}
