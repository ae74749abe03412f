// SPDX-License-Identifier: BSL-1.0
// Long: two languages with the same helpers; the last cases compare both.
#include <quadrant/path/cl_reader.hpp>
#include <quadrant/path/gcode_reader.hpp>

#include <doctest/doctest.h>

#include <sstream>

using namespace quadrant;
using namespace quadrant::path;

namespace {
constexpr double pi_ = std::numbers::pi;

template <class Reader> std::vector<move> all(Reader& reader) {
    std::vector<move> out;
    while (const auto next = reader.next()) out.push_back(*next);
    return out;
}
template <class Reader> std::vector<move> read(const std::string& text, const program_start& start = {}) {
    std::istringstream in(text);
    Reader reader(in, "part", start);
    return all(reader);
}
template <class Reader> std::vector<move> read_file(const std::string& name) {
    auto in = open_program(std::string(QUADRANT_SOURCE_DIR).append("/examples/path/").append(name));
    Reader reader(in, name);
    return all(reader);
}
template <class Reader> std::string refused(const std::string& text) {
    try {
        read<Reader>(text);
    } catch (const bad_program& fault) {
        return fault.what();
    }
    return "read";
}
auto nc(const std::string& text, const program_start& start = {}) { return read<gcode_reader>(text, start); }
auto cl(const std::string& text, const program_start& start = {}) { return read<cl_reader>(text, start); }
const auto no_nc = refused<gcode_reader>;
const auto no_cl = refused<cl_reader>;

constexpr point mm(double x, double y, double z = 0) { return {1e-3 * x, 1e-3 * y, 1e-3 * z}; }
bool near(point a, point b) { return distance(a, b) < 1e-12; }
bool near(double a, double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); }

/// Lines of a program that is never in memory.
class endless : public std::streambuf {
public:
    endless(std::string head, std::string body, std::size_t times)
        : head_(std::move(head)), body_(std::move(body)), left_(times) {
        setg(head_.data(), head_.data(), head_.data() + head_.size());
    }
    int_type underflow() override {
        if (left_-- == 0) return traits_type::eof();
        setg(body_.data(), body_.data(), body_.data() + body_.size());
        return traits_type::to_int_type(*gptr());
    }

private:
    std::string head_, body_;
    std::size_t left_;
};
} // namespace

TEST_CASE("G-code: lines, modal words, units, absolute and incremental, by hand") {
    const auto m = nc("%\nO100 (part 1)\nn10 G21 g90 G17 G40 T1 M6\nM3 S2000\nG0 X10 Y-5\nZ2.5 ; down\n"
                      "G1 X 20 F600\nG91 Y+5. Z-.5\nG20 X1\nG90 G1 X0Y0 F10\nM5 M30\nG99",
                      {.place = mm(0, 0, 5)});
    REQUIRE(m.size() == 6);
    CHECK((m[0].rapid && m[0].line == 5 && near(m[0].path.start(), mm(0, 0, 5)) &&
           near(m[0].path.end(), mm(10, -5, 5))));
    CHECK((m[1].rapid && m[1].line == 6 && near(m[1].path.end(), mm(10, -5, 2.5))));
    CHECK((!m[2].rapid && near(m[2].feed, 0.01) && near(m[2].path.end(), mm(20, -5, 2.5))));
    CHECK(near(m[3].path.end(), mm(20, 0, 2)));
    CHECK((near(m[4].path.end(), mm(45.4, 0, 2)) && near(m[4].feed, 0.01)));
    CHECK((near(m[5].path.end(), mm(0, 0, 2)) && near(m[5].feed, 10 * 0.0254 / 60)));
    for (std::size_t i = 1; i < m.size(); ++i) CHECK(m[i].path.start() == m[i - 1].path.end());
}
TEST_CASE("G-code: arcs with I J and with R, full circle, helix, in both senses") {
    const auto m = nc("F6000 G3 X10 Y10 I0 J10\nG2 X20 Y20 R10\nG2 X10 Y10 R-10\nG3 I-5\nG2 X10 Y0 Z3 J-5\n");
    REQUIRE(m.size() == 5);
    const auto round = [&](std::size_t i) { return std::get<arc>(m[i].path.shape()); };
    CHECK((near(round(0).sweep(), pi_ / 2) &&
           near(round(0).centre(), mm(0, 10)))); // from the bottom to the right
    CHECK((near(round(1).sweep(), -pi_ / 2) && near(round(1).centre(), mm(20, 10))));
    CHECK(
        (near(round(2).sweep(), -3 * pi_ / 2) && near(round(2).centre(), mm(20, 10)))); // on round that circle
    CHECK((near(round(3).sweep(), 2 * pi_) && near(round(3).radius(), 0.005) &&
           near(round(3).centre(), mm(5, 10))));
    CHECK((near(round(4).sweep(), -pi_) && near(m[4].path.length(), std::hypot(0.005 * pi_, 0.003))));
    CHECK(near(m[4].path.end(), mm(10, 0, 3)));
}
TEST_CASE("G-code: an arc whose end is rounded ends where it is written") {
    const auto m = nc("G1 F100 X35.355 Y35.355\nG3 X-35.355 Y35.356 I-35.355 J-35.355\nG1 X0 Y0\n");
    REQUIRE(m.size() == 3);
    CHECK(near(m[1].path.end(), mm(-35.355, 35.356)));
    CHECK(near(m[2].path.start(), mm(-35.355, 35.356)));
    CHECK(std::abs(std::get<arc>(m[1].path.shape()).radius() - 0.05) < 2e-6);
}
TEST_CASE("G-code: stops, tolerances and dwells") {
    const auto m = nc("G4 P1.5\nG64 P0.02 G1 F100 X1\nX2\nG4 P.5\nG4 P1\nX3 G61\nG64 X4\nX5\nM0\nX6\nX7 G64");
    REQUIRE(m.size() == 7);
    using enum path_ending;
    const path_ending endings[]{continuous, exact_stop, exact_stop, continuous,
                                exact_stop, continuous, exact_stop};
    for (std::size_t i = 0; i < 7; ++i) CHECK(m[i].ending == endings[i]);
    CHECK((m[0].tolerance == 2e-5 && m[1].tolerance == 0 && m[3].tolerance == 0));
    CHECK((m[0].dwell_before == 1.5 && m[1].dwell == 1.5 && m[2].dwell == 0 && m[1].dwell_before == 0));
    CHECK(nc("G1 F1 X1\nX2", {.ending = continuous, .tolerance = 1e-5})[0].tolerance == 1e-5);
    CHECK(nc("G1 F1 X1\nX1\nG91 X0\nX1").size() == 2); // no way to go: no move
}
TEST_CASE("G-code: what cannot be is refused by file, line, column and word") {
    CHECK(no_nc("G1 X1") == "part:1:4: the feed is zero: no F before this move");
    CHECK(no_nc("G0 X1\nG1 F0 X2") == "part:2:4: the feed is zero");
    CHECK(no_nc("G1 F-5 X2") == "part:1:4: \"F-5\": must not be below 0");
    CHECK(no_nc("F100\nG2 X10 I5.02") == "part:2:8: the end of the arc is not on it: its centre is 5.020000 mm "
                                         "from the start and 4.980000 mm from the end");
    CHECK(no_nc("F100 G2 X10 Y0 R4") == "part:1:16: the end of the arc is not on it: start and end are "
                                        "10.000000 mm apart, the radius is 4.000000 mm");
    CHECK(no_nc("F100 G3 R4") == "part:1:9: an arc to where it starts needs I J, not R");
    CHECK(no_nc("F100 G3 X4") == "part:1:9: an arc needs I J or R");
    CHECK(no_nc("F100 G3 I0 J0") == "part:1:9: the radius of the arc is zero");
    CHECK(no_nc("F100 G3 X1 I1 R1") == "part:1:15: R and I J in one block");
    for (const char* word :
         {"G18", "G19", "G2.1", "G5",  "G10", "G28", "G41", "G43", "G53", "G55", "G81", "G90.1", "G93",
          "G95", "M19", "M98",  "A10", "B1",  "K2",  "D1",  "H1",  "Q1",  "L3",  "E1",  "U1"})
        CHECK(no_nc(std::string("G0 X1\n").append(word)) ==
              std::string("part:2:1: \"").append(word).append("\" is not supported"));
    CHECK(no_nc("X1") == "part:1:1: no G0, G1, G2 or G3 says how to go there");
    CHECK(no_nc("G0 G1 X1") == "part:1:4: \"G1\": another word of its group stands in the block");
    CHECK(no_nc("G0 X1 Y2 X3") == "part:1:10: \"X3\": the letter occurs twice in the block");
    CHECK(no_nc("G0 X") == "part:1:5: a number is missing");
    CHECK(no_nc("G0 X1e3") == "part:1:6: \"e3\" is not supported");
    CHECK(no_nc("G0 X#5") == "part:1:5: parameters and expressions are not supported");
    CHECK(no_nc("#5=3") == "part:1:1: parameters and expressions are not supported");
    CHECK(no_nc("/G0 X1") == "part:1:1: optional blocks (/) are not supported");
    CHECK(no_nc("G0 X1 (no end") == "part:1:7: the comment has no end");
    CHECK(no_nc("(a (b)) G0") == "part:1:1: a comment inside a comment");
    CHECK(no_nc("G0 X1 I3") == "part:1:7: I belongs to G2 or G3");
    CHECK(no_nc("G0 X1 P3") == "part:1:7: P belongs to G4 or G64");
    CHECK(no_nc("G4") == "part:1:1: G4 needs P, the time in seconds");
    CHECK(no_nc("G4 P1 X3") == "part:1:1: G4 stands in a block of its own");
    CHECK(no_nc("G0 X1e") == "part:1:7: a number is missing");
    CHECK(no_nc("(\xC3\xA9) G7") == "part:1:5: \"G7\" is not supported"); // columns are characters
    CHECK(no_nc("G21\nM30\nG0 X1") == "part: holds no move");
    CHECK(no_nc("") == "part: holds no move");
    CHECK(no_nc(std::string(5000, ' ')) == "part:1:4097: the line is longer than 4096 characters");
    CHECK_THROWS_WITH_AS(open_program("/no/such.nc"), "/no/such.nc: cannot be opened", bad_program);
}
TEST_CASE("CL: places, feeds, units, rapid for one move, comments and continuation") {
    const auto m = cl("PARTNO A PART $$ 7\n$$ UNITS/INCHES\nMACHIN/MILL,1\nUNITS/MM\nFROM/0,0,10\nrapid\nGOTO "
                      "/ 10, 0 , $ PT 1\n"
                      " 0.5\nSPINDL/2000,RPM,CLW\nFEDRAT/120.,MMPM\nGOTO/10,20,.5,0,0,1\nDELAY/2\nFEDRAT/"
                      "IPM,6\nGODLTA/0,0,-1\n"
                      "UNITS/INCHES\nFEDRAT/12\nGOTO/1,1,1\nLOADTL/2\nGOTO/1,2,1\nFINI\nGARBAGE");
    REQUIRE(m.size() == 5);
    CHECK((m[0].rapid && m[0].line == 7 && near(m[0].path.start(), mm(0, 0, 10)) &&
           near(m[0].path.end(), mm(10, 0, .5))));
    CHECK((!m[1].rapid && near(m[1].feed, 0.002) && near(m[1].path.end(), mm(10, 20, .5)) && m[1].dwell == 2));
    CHECK((near(m[2].feed, 0.00254) && near(m[2].path.end(), mm(10, 20, -.5))));
    CHECK((near(m[3].feed, 0.00508) && near(m[3].path.end(), mm(25.4, 25.4, 25.4))));
    CHECK(m[3].ending == path_ending::exact_stop);
    CHECK(cl("FEDRAT/1\nGOTO/1,0,0\nSTOP\nGOTO/2,0,0\nGOTO/3,0,0", {.ending = path_ending::continuous})[0]
              .ending == path_ending::exact_stop);
}
TEST_CASE("CL: the same quarter of a circle as Creo, NX, Autodesk and CATIA write it") {
    const char* const forms[]{
        "CIRCLE / 10, 0, 0, $\n 0.0, 0.0, -1.0, 10.0\nGOTO / 10, 10, 0\n",
        "CIRCLE/10.0,0.0,0.0,0.0,0.0,-1.0,10.0,0.06,0.5,10.0,0.0\nGOTO/10,10,0\n",
        "MOVARC/10, 0, 0, 0, 0, -1, 10, ANGLE, 90\nGOTO/10, 10, 0\n",
        "INDIRV/ 0.0, 1.0, 0.0\nTLON,GOFWD/ (CIRCLE/ 10.0, 0.0, 0.0,$        CIR    1\n 10.0),ON,(LINE/ 10.0, "
        "0.0, 0.0,$\n"
        " 10.0, 10.0, 0.0)\n",
    };
    for (const char* form : forms) {
        const auto m = cl(std::string("FEDRAT/100,MMPM\n").append(form));
        REQUIRE(m.size() == 1);
        const arc round = std::get<arc>(m[0].path.shape());
        CHECK(near(round.sweep(), -pi_ / 2));
        CHECK(near(round.centre(), mm(10, 0)));
        CHECK(near(round.end(), mm(10, 10)));
    }
}
TEST_CASE("CL: full circles, helices, and the n-th meeting of circle and line") {
    const auto helix = cl("FEDRAT/1\nCIRCLE/5,0,0,0,0,1,5\nGOTO/0,0,2\n");
    CHECK(near(helix[0].path.length(), std::hypot(0.01 * pi_, 0.002)));
    const auto towards = [&](const char* n) {
        return cl(std::string("FEDRAT/1\nINDIRV/0,-1,0\nTLON,GOFWD/(CIRCLE/5,0,0,5),ON,")
                      .append(n)
                      .append("(LINE/0,0,0,10,0,0)"))[0];
    };
    CHECK(near(std::get<arc>(towards("").path.shape()).sweep(), pi_)); // from (0, 0) down: counterclockwise
    CHECK(near(std::get<arc>(towards("1,INTOF,").path.shape()).sweep(), pi_));
    CHECK(near(std::get<arc>(towards("2,INTOF,").path.shape()).sweep(), 2 * pi_));
}
TEST_CASE("CL: a spline through GOTO places is the spline path, its feed and lines those of the places") {
    const auto m = cl(
        "FEDRAT/60\nGOTO/1,1,0\nSPLINE/QUINTIC\nGOTO/5,2,0\nGOTO/9,0,0\nFEDRAT/120\nGOTO/14,3,0\nGOTO/15,8,1\n"
        "GOTO/12,12,0\nSPLINE/OFF\nGOTO/0,0,0\n",
        {.ending = path_ending::continuous, .tolerance = 1e-5});
    const auto path = splines_through({mm(1, 1), mm(5, 2), mm(9, 0), mm(14, 3), mm(15, 8, 1), mm(12, 12)});
    REQUIRE(m.size() == path.size() + 2);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const move& piece = m[i + 1];
        CHECK(near(piece.path.position(path[i].length() / 3), path[i].position(path[i].length() / 3)));
        CHECK(near(piece.feed, piece.line < 6 ? 0.001 : 0.002));
        CHECK(piece.ending == path_ending::continuous);
        CHECK(piece.tolerance == (i + 1 < path.size() ? 0 : 1e-5));
    }
    CHECK((m[1].line == 4 && m[path.size()].line == 9));
}
TEST_CASE("CL: what cannot be is refused by file, line, column and word") {
    CHECK(no_cl("GOTO/1,0,0") == "part:1:1: GOTO: the feed is zero: no FEDRAT before this move");
    CHECK(no_cl("FEDRAT/0,MMPM") == "part:1:8: FEDRAT: the feed is zero");
    CHECK(no_cl("FEDRAT/0.1,MMPR") ==
          "part:1:12: FEDRAT: a value with MMPM, IPM or PERMIN is what is supported");
    CHECK(no_cl("FEDRAT/1\nCIRCLE/5,0,0,0,0,1,5\nGOTO/0,8,0") ==
          "part:3:1: GOTO: the end of the arc is not on it: its centre is 5.000000 mm from the start and "
          "9.433981 mm from the end");
    CHECK(no_cl("FEDRAT/1\nCIRCLE/5,0,0,0,0,1,6\nGOTO/10,0,0") ==
          "part:3:1: GOTO: the start of the arc is not on it: it is 5.000000 mm from the centre, the radius is "
          "6.000000 mm");
    CHECK(no_cl("FEDRAT/1\nMOVARC/5,0,0,0,0,1,5,ANGLE,90\nGOTO/10,0,0") ==
          "part:3:1: GOTO: the end of the arc is not on it: ANGLE says 90.000000 degrees, the end is at "
          "180.000000");
    CHECK(no_cl("FEDRAT/1\nINDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/5,0,0,5),ON,(LINE/0,6,0,1,6,0)") ==
          "part:3:1: TLON: the end of the arc is not on it: the line does not meet the circle");
    CHECK(no_cl("FEDRAT/1\nINDIRV/1,0,0\nTLON,GOFWD/(CIRCLE/5,0,0,5),ON,(LINE/0,0,0,1,0,0)") ==
          "part:3:1: TLON: INDIRV does not say which way round");
    CHECK(no_cl("CIRCLE/0,0,0,0,1,0,5") == "part:1:14: CIRCLE: only 0,0,1 and 0,0,-1 are supported here");
    CHECK(no_cl("CIRCLE/1,0,0,0,0,1,1\nFINI") == "part:2:1: FINI: the arc before it wants GOTO, its end");
    CHECK(no_cl("CIRCLE/1,0,0,0,0,1,1") == "part:1:1: end of the file: the arc before it wants GOTO, its end");
    CHECK(no_cl("FEDRAT/1\nSPLINE/CUBIC\nGOTO/1,0,0\n  GOTO/1,0,0") ==
          "part:4:3: GOTO: the spline has two points at the same place");
    CHECK(no_cl("FEDRAT/1\nSPLINE/CUBIC\nGOTO/1,0,0\nGOTO/0,0,0\nSPLINE/OFF") ==
          "part:5:1: SPLINE: the spline turns back at the point of line 3");
    CHECK(no_cl("FEDRAT/1\nSPLINE/CUBIC\nGOTO/1,0,0\nRAPID") ==
          "part:4:1: RAPID: inside SPLINE; SPLINE/OFF ends it");
    CHECK(no_cl("FEDRAT/1\nSPLINE/CUBIC\nGOTO/1,0,0\n") ==
          "part:3:1: end of the file: inside SPLINE; SPLINE/OFF ends it");
    CHECK(no_cl("SPLINE/QUINTIC\nSPLINE/OFF") == "part:2:1: SPLINE: the spline goes nowhere: no GOTO in it");
    CHECK(no_cl("SPLINE/NURBS") == "part:1:8: SPLINE: only QUINTIC, CUBIC and OFF are supported");
    for (const char* word : {"CYCLE", "GOHOME", "ORIGIN", "TRANS", "INSERT", "P1", "MSYS", "COPY", "GORGT"})
        CHECK(no_cl(std::string(word).append("/1,2")) ==
              std::string("part:1:1: \"").append(word).append("\" is not supported"));
    CHECK(no_cl("MULTAX/ON") == "part:1:8: MULTAX: only OFF is supported");
    CHECK(no_cl("CUTCOM/LEFT") == "part:1:8: CUTCOM: only OFF is supported");
    CHECK(no_cl("UNITS/CM") == "part:1:7: UNITS: only MM and INCHES are supported");
    CHECK(no_cl("GOTO/1,2,3,0,1,0") == "part:1:12: GOTO: only 0,0,1 and 0,0,-1 are supported here");
    CHECK(no_cl("GOTO/1,2") == "part:1:1: GOTO: here must stand ,");
    CHECK(no_cl("GOTO/1,2,X") == "part:1:10: GOTO: a number is missing");
    CHECK(no_cl("GOTO/1,2,$\n%") == "part:2:1: \"%\" is not supported");
    CHECK(no_cl("GOTO/1,2,$") == "part: ends inside a statement");
    CHECK(no_cl("UNITS/MM") == "part: holds no move");
}
TEST_CASE("readers: a program of any length is read a few lines ahead of its moves") {
    const auto few_ahead = [](auto& reader, std::size_t head) {
        std::size_t moves = 0;
        while (reader.next()) {
            ++moves;
            REQUIRE(reader.lines_read() <= moves + head);
        }
        return moves;
    };
    endless nc_lines("G91 G1 F100\n", "X1 Y2\n", 20000);
    std::istream nc_in(&nc_lines);
    gcode_reader nc_reader(nc_in, "part");
    CHECK(few_ahead(nc_reader, 2) == 20000);
    endless cl_lines("FEDRAT/100\nSPLINE/QUINTIC\n", "GODLTA/1,2,0\n", 20000);
    std::istream cl_in(&cl_lines);
    cl_reader cl_run(cl_in, "part");
    CHECK_THROWS_AS(few_ahead(cl_run, 8), bad_program); // the run has no end: SPLINE/OFF is missed only there
    CHECK(cl_run.lines_read() == 20002);
    CHECK_FALSE(cl_run.next());
}
TEST_CASE("readers: the example programs say the same in both languages") {
    for (const std::string name : {"circle", "diamond"}) {
        const auto a = read_file<gcode_reader>(name + ".nc"), b = read_file<cl_reader>(name + ".cl");
        REQUIRE(a.size() == b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double third = a[i].path.length() / 3;
            CHECK((near(a[i].path.position(third), b[i].path.position(third)) && near(a[i].feed, 0.2)));
            CHECK(
                (near(b[i].feed, 0.2) && a[i].ending == path_ending::exact_stop && b[i].ending == a[i].ending));
        }
    }
    const auto circle = read_file<gcode_reader>("circle.nc"), diamond = read_file<gcode_reader>("diamond.nc");
    CHECK((circle.size() == 1 && near(circle[0].path.length(), 0.1 * pi_)));
    REQUIRE(diamond.size() == 4);
    for (const move& side : diamond) CHECK(std::abs(side.path.length() - 0.05) < 1e-9);

    const auto chords = read_file<gcode_reader>("butterfly.nc"), curve = read_file<cl_reader>("butterfly.cl");
    const auto total = [](const std::vector<move>& moves) {
        double sum = 0;
        for (const move& m : moves) sum += m.path.length();
        return sum;
    };
    // Length of r = 10 mm exp(cos t) - 20 mm cos 4t: the integral of hypot(r, r'), rectangles of a periodic
    // function.
    double length = 0;
    for (int i = 0; i < 5000; ++i) {
        const double t = 2 * pi_ * i / 5000, e = 0.01 * std::exp(std::cos(t));
        length +=
            std::hypot(e - 0.02 * std::cos(4 * t), -e * std::sin(t) + 0.08 * std::sin(4 * t)) * 2 * pi_ / 5000;
    }
    CHECK(chords.size() == 240);
    CHECK(std::abs(total(curve) - length) < 5e-6);
    CHECK(total(chords) < total(curve));
    CHECK(near(curve.back().path.end(), chords.back().path.end()));
}
