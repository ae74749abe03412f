// SPDX-License-Identifier: BSL-1.0
// usage: controller_docs DOCS      writes the tables of DOCS/controllers.md, and
// DOCS/schema/controllers.schema.json
#include "page.hpp"
#include "schema.hpp"

#include <quadrant/diagnosis/text/text.hpp>

#include <fstream>

int main(int count, char** arguments) {
    if (count != 2) {
        fmt::print(stderr, "usage: controller_docs DOCS\n");
        return 2;
    }
    const std::filesystem::path docs = arguments[1];
    const std::string page = controller_docs::page(
        controller_docs::intro_of(quadrant::diagnosis::detail::read_whole(docs / "controllers.md")));
    std::ofstream(docs / "controllers.md") << page;
    std::ofstream(docs / "schema" / "controllers.schema.json") << controller_docs::schema().dump(2) << "\n";
}
