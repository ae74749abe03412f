// SPDX-License-Identifier: BSL-1.0
#include "printed/appendices.hpp"
#include "printed/chapter2.hpp"
#include "printed/chapter4.hpp"
#include "printed/chapter5.hpp"
#include "printed/stage.hpp"
#include "printed/virtual_cnc.hpp"
#include "publication.hpp"

quadrant_reproduce::printed_list quadrant_reproduce::printed_numbers() {
    printed_list all;
    print_chapter2(all);
    print_chapter3(all);
    print_chapter4(all);
    print_chapter5(all);
    print_appendices(all);
    print_virtual_cnc(all);
    print_stage(all);
    return all;
}
