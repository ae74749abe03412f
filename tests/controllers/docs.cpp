// SPDX-License-Identifier: BSL-1.0
#include "controller_docs/page.hpp"
#include "controller_docs/schema.hpp"
#include "workshop.hpp"

#include <doctest/doctest.h>

TEST_CASE("controller docs: page and schema are what the records say (else: controller_docs docs)") {
    const std::filesystem::path docs = QUADRANT_SOURCE_DIR "/docs";
    const std::string page = quadrant::diagnosis::detail::read_whole(docs / "controllers.md");
    CHECK(controller_docs::page(controller_docs::intro_of(page)) == page);
    CHECK(controller_docs::schema().dump(2) + "\n" ==
          quadrant::diagnosis::detail::read_whole(docs / "schema" / "controllers.schema.json"));
}
