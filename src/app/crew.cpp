#include "crew.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <mpi.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace nsma::app {
namespace {

enum Tag { tag_unit = 1, tag_result, tag_dismissed, tag_goodbye };
constexpr int child_worker = 0;  // the child of rank 0; rank r is worker r

// A number of the environment that a launcher of MPI programs set, or -1.
int launched(const char* open_mpi, const char* slurm) {
    for (const char* key : {open_mpi, slurm}) {
        // srun with PMIx or PMI-2; without either it did not start an MPI program.
        if (key == slurm && std::getenv("PMIX_RANK") == nullptr && std::getenv("PMI_RANK") == nullptr) continue;
        if (const char* value = std::getenv(key)) return static_cast<int>(std::strtol(value, nullptr, 10));
    }
    return -1;
}

int launched_rank() { return launched("OMPI_COMM_WORLD_RANK", "SLURM_PROCID"); }
int launched_size() { return launched("OMPI_COMM_WORLD_SIZE", "SLURM_NTASKS"); }

bool write_all(int file, const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::write(file, at, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        at += written;
        size -= static_cast<std::size_t>(written);
    }
    return true;
}

bool read_all(int file, void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
        const ssize_t got = ::read(file, at, size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

bool write_message(int file, const std::string& bytes) {
    const std::uint64_t size = bytes.size();
    return write_all(file, &size, sizeof size) && write_all(file, bytes.data(), bytes.size());
}

std::optional<std::string> read_message(int file) {
    std::uint64_t size = 0;
    if (!read_all(file, &size, sizeof size)) return std::nullopt;
    std::string bytes(size, '\0');
    if (!read_all(file, bytes.data(), bytes.size())) return std::nullopt;
    return bytes;
}

void send(int rank, Tag tag, const std::string& bytes) {
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD);
}

struct Received {
    int rank = 0;
    int tag = 0;
    std::string bytes;
};

std::optional<Received> receive() {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return std::nullopt;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Received received{status.MPI_SOURCE, status.MPI_TAG, std::string(static_cast<std::size_t>(size), '\0')};
    MPI_Recv(received.bytes.data(), size, MPI_BYTE, received.rank, received.tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return received;
}

}  // namespace

struct Crew::Implementation {
    // The wait between two looks for a message. It grows while none comes: where results come quickly they are answered
    // at once, where solves are long the processor is left to them. At most half a millisecond is lost, at a look's
    // cost of some ten microseconds.
    class Pause {
    public:
        [[nodiscard]] std::chrono::microseconds next() {
            const auto now = length_;
            length_ = std::min(2 * length_, longest);
            return now;
        }
        void over() { length_ = shortest; }

    private:
        static constexpr std::chrono::microseconds shortest{20}, longest{500};
        std::chrono::microseconds length_ = shortest;
    };

    bool mpi = false;
    int rank = 0;
    int ranks = 1;
    bool is_child = false;
    pid_t child = -1;
    int in = -1;   // from the child, or from rank 0
    int out = -1;  // to it
    bool dismissed = false;
    bool left = false;
    Pause pause;
    std::set<int> gone;  // ranks that left

    void split() {
        int down[2], up[2];
        // What MPI starts must not keep the child's pipes open.
        if (pipe2(down, O_CLOEXEC) != 0 || pipe2(up, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
        child = fork();
        if (child < 0) throw std::runtime_error("cannot start a process");
        is_child = child == 0;
        in = is_child ? down[0] : up[0];
        out = is_child ? up[1] : down[1];
        close(is_child ? down[1] : down[0]);
        close(is_child ? up[0] : up[1]);
    }

    void drop_child() {
        if (child <= 0) return;
        close(in);
        close(out);
        in = out = -1;
        while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
        }
        child = -1;
    }
};

Crew::Crew() : implementation_(std::make_unique<Implementation>()) {
    auto& self = *implementation_;
    if (launched_size() < 2) return;
    if (launched_rank() == 0) self.split();
    if (self.is_child) return;
    MPI_Init(nullptr, nullptr);
    self.mpi = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &self.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &self.ranks);
    // The variables were left over from another launch: this process is alone.
    if (self.ranks < 2) self.drop_child();
}

Crew::~Crew() {
    auto& self = *implementation_;
    if (!self.mpi) return;
    if (self.rank == 0) {
        for (int rank = 1; rank < self.ranks; ++rank) {
            if (!self.gone.contains(rank)) send(rank, tag_dismissed, {});
        }
        self.drop_child();
        while (static_cast<int>(self.gone.size()) < self.ranks - 1) {
            const auto received = receive();
            if (!received) std::this_thread::sleep_for(self.pause.next());
            if (received && received->tag == tag_goodbye) self.gone.insert(received->rank);
        }
    } else {
        // Before its dismissal only an error ends a helper: then everything ends, what is stored stays.
        if (!self.dismissed) MPI_Abort(MPI_COMM_WORLD, 4);
        if (!self.left) send(0, tag_goodbye, {});
    }
    MPI_Finalize();
}

bool Crew::helper() const { return implementation_->is_child || implementation_->rank > 0; }

int Crew::workers() const { return implementation_->ranks > 1 ? implementation_->ranks : 0; }

bool Crew::present(int worker) const {
    return worker == child_worker ? implementation_->child > 0 : !implementation_->gone.contains(worker);
}

void Crew::hand(int worker, const std::string& bytes) {
    auto& self = *implementation_;
    if (worker != child_worker) {
        send(worker, tag_unit, bytes);
    } else {
        (void)write_message(self.out, bytes);  // a child that is gone shows when it is read
    }
}

std::optional<Crew::Message> Crew::wait() {
    auto& self = *implementation_;
    if (auto received = receive()) {
        self.pause.over();
        const bool lost = received->tag == tag_goodbye;
        if (lost) self.gone.insert(received->rank);
        return Message{received->rank, lost, std::move(received->bytes)};
    }
    if (self.child <= 0) {
        std::this_thread::sleep_for(self.pause.next());
        return std::nullopt;
    }
    pollfd file{self.in, POLLIN, 0};
    const timespec moment{0, std::chrono::nanoseconds(self.pause.next()).count()};
    if (ppoll(&file, 1, &moment, nullptr) <= 0) return std::nullopt;
    self.pause.over();
    if (auto bytes = read_message(self.in)) return Message{child_worker, false, std::move(*bytes)};
    self.drop_child();
    return Message{child_worker, true, {}};
}

std::optional<std::string> Crew::next() {
    auto& self = *implementation_;
    if (self.is_child) return read_message(self.in);
    while (!self.dismissed) {
        auto received = receive();
        if (!received) {
            std::this_thread::sleep_for(self.pause.next());
            continue;
        }
        self.pause.over();
        if (received->tag == tag_unit) return std::move(received->bytes);
        self.dismissed = true;
    }
    return std::nullopt;
}

void Crew::report(const std::string& bytes) {
    auto& self = *implementation_;
    if (!self.is_child) {
        send(0, tag_result, bytes);
    } else if (!write_message(self.out, bytes)) {
        std::_Exit(0);  // rank 0 is gone, and with it everyone who could use the result
    }
}

void Crew::leave() {
    auto& self = *implementation_;
    if (self.is_child) std::_Exit(0);
    self.left = self.dismissed = true;
    send(0, tag_goodbye, {});
}

}  // namespace nsma::app
