// SPDX-License-Identifier: BSL-1.0
// Writes what the docs and the schemas say of effects from the records of the list: effect_tables ROOT. With
// --check it changes nothing, names the files that are stale, and exits with 1 when there is one (ctest
// docs.effects).
#include "schema.hpp"
#include "tables.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>

namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path.string() + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The text with everything between two lines replaced: those that contain `begin` and, behind it, `end`.
std::string spliced(const fs::path& path, std::string text, const std::string& begin, const std::string& end,
                    const std::string& between) {
    const auto from = text.find('\n', text.find(begin));
    const auto mark = from == text.npos ? text.npos : text.find(end, from);
    if (text.find(begin) == text.npos || mark == text.npos)
        throw std::runtime_error(fmt::format("{}: {} or {} is missing", path.string(), begin, end));
    return text.replace(from + 1, text.rfind('\n', mark) - from, between);
}

struct generated {
    const char *file, *begin, *end;
    std::string text;
};

} // namespace

int main(int count, char** words) try {
    const bool check = count == 3 && std::string_view(words[2]) == "--check";
    if (count != 2 && !check) throw std::runtime_error("usage: effect_tables ROOT [--check]");
    using namespace effect_tables;
    const fs::path docs = fs::path(words[1]) / "docs";
    const char *from = "begin_of_effects", *to = "end_of_effects", *end = "<!-- end of effects -->";
    const generated all[] = {
        {"schema/machine.schema.json", from, to, as_definitions(machine_definitions())},
        {"schema/diagnosis.schema.json", from, to, as_definitions({{"effect", effect_names()}})},
        {"formats.md", "<!-- effects: keys -->", end, machine_keys()},
        {"diagnosis.md", "<!-- effects: what it can name -->", end, what_it_can_name()},
        {"diagnosis.md", "<!-- effects: what pays -->", end, what_pays()},
        {"effects.md", "<!-- effects: where -->", end, where(docs)},
        {"effects.md", "<!-- effects: odds and remedies -->", end, odds_and_remedies()},
        {"README.md", "<!-- effects: pages -->", end, pages(docs)},
    };
    int stale = 0;
    for (const generated& g : all) {
        const fs::path path = docs / g.file;
        const std::string before = read(path), after = spliced(path, before, g.begin, g.end, g.text);
        if (after == before) continue;
        ++stale;
        std::printf("%s: %s\n", path.c_str(), check ? "is stale: run effect_tables" : "written");
        if (!check && !(std::ofstream(path, std::ios::binary) << after))
            throw std::runtime_error(path.string() + ": cannot be written");
    }
    return check && stale > 0 ? 1 : 0;
} catch (const std::exception& fault) {
    std::fprintf(stderr, "effect_tables: %s\n", fault.what());
    return 2;
}
