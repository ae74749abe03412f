// SPDX-License-Identifier: BSL-1.0
// quadrant-gap-mpi: quadrant-gap fleet over many hosts. The first process leads, and works beside it.
#include "../quadrant_gap/commands.hpp"
#include "../quadrant_gap/fleet/fleet.hpp"

#include <cstdlib>
#include <filesystem>
#include <mpi.h>
#include <vector>

namespace {

using namespace quadrant_gap;

constexpr int text_tag = 1;

void send(int to, const std::string& text) {
    MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, text_tag, MPI_COMM_WORLD);
}

/// Looks and does not wait: MPI waits by keeping a core busy, and that core has diagnoses to make.
std::optional<std::pair<int, std::string>> received() {
    int here = 0, length = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, text_tag, MPI_COMM_WORLD, &here, &status);
    if (!here) return std::nullopt;
    MPI_Get_count(&status, MPI_CHAR, &length);
    std::string text(static_cast<std::size_t>(length), ' ');
    MPI_Recv(text.data(), length, MPI_CHAR, status.MPI_SOURCE, text_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return std::pair{status.MPI_SOURCE, text};
}

struct mpi_crew final : fleet::crew {
    int size = 1;
    int others() const override { return size - 1; }
    void give(int to, const std::string& text) override { send(to, text); }
    std::optional<std::pair<int, std::string>> hear() override { return received(); }
};

struct mpi_leader final : fleet::leader {
    void tell(const std::string& text) override { send(0, text); }
    std::optional<std::string> hear() override {
        auto heard = received();
        if (!heard) return std::nullopt;
        return std::move(heard->second);
    }
};

int run(const fleet::options& o) {
    constexpr int bad_input_code = 2;
    int rank = 0;
    mpi_crew others;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &others.size);
    try {
        if (rank == 0) {
            fleet::lead(o, others);
        } else {
            mpi_leader boss;
            fleet::help(o, boss);
        }
        return 0;
    } catch (const quadrant::diagnosis::bad_input& e) { // the leader has dismissed the others
        std::fprintf(stderr, "quadrant-gap-mpi: %s\n", e.what());
    } catch (const std::exception& e) {
        std::fprintf(stderr, "quadrant-gap-mpi: %s\n", e.what());
        MPI_Abort(MPI_COMM_WORLD, bad_input_code);
    }
    return bad_input_code;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Many machines on many hosts: mpirun -n PROCESSES quadrant-gap-mpi DIR", "quadrant-gap-mpi"};
    fleet::options o;
    terminal say;
    fleet::add_options(app, o);
    add_terminal_options(app, say, "every log as it is done");
    app.footer("Exit code: 0 when every log has its diagnosis, else 2 (one line says where).");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
        if (rank && std::string_view(rank) != "0") return e.get_exit_code() == 0 ? 0 : 2; // one of them speaks
        return app.exit(e) == 0 ? 0 : 2;
    }
    if (o.program.empty()) // the one beside this
        o.program = std::filesystem::read_symlink("/proc/self/exe").replace_filename("quadrant-gap").string();
    o.quiet = say.quiet;
    o.verbose = say.verbose;
    MPI_Init(&argc, &argv);
    const int code = run(o);
    MPI_Finalize();
    return code;
}
