// SPDX-License-Identifier: BSL-1.0
// usage: block_pictures FOLDER [NAME]
// Writes FOLDER/NAME.svg, the picture of docs/blocks/NAME.md; of every block without NAME.
//
// A new block: one function that runs it, and one line at the end of the file of its family.
#include "families.hpp"
#include "svg_file.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>

int main(int argc, char** argv) {
    using namespace block_pictures;
    if (argc < 2 || argc > 3) {
        std::cerr << "usage: block_pictures FOLDER [NAME]\n";
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    int written = 0;
    for (const auto& members :
         {filters, signals, supervision, memories, frictions, laws, polynomial_laws, feedforwards, plants,
          drives, observers, force_and_friction, loops, published_machines})
        for (const entry& e : members()) {
            if (argc == 3 && std::string(argv[2]) != e.block) continue;
            std::ofstream file(folder / (std::string(e.block) + ".svg"), std::ios::binary);
            file << svg_file(e.draw()).text();
            if (!file.flush()) {
                std::cerr << "cannot write into " << folder.string() << '\n';
                return 1;
            }
            ++written;
        }
    std::cout << written << " pictures in " << folder.string() << '\n';
    return written > 0 ? 0 : 1;
}
