#include "bench/machine/machine.h"

#include "trees/buffer.h"

#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

namespace boxwood::bench {
namespace {

using std::filesystem::path;

/// The first line of a file, empty where there is none.
std::string line_of(const path& file) {
    std::string line;
    std::getline(std::ifstream(file) >> std::ws, line);
    return line;
}

/// The value of the first line "key : value" of a text.
std::string value_of(std::istream&& text, std::string_view key) {
    for (std::string line; std::getline(text, line);) {
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos || !line.starts_with(key))
            continue;
        const std::size_t last = line.find_last_not_of(" \t", colon - 1);
        if (last + 1 != key.size())
            continue;
        const std::size_t first = line.find_first_not_of(" \t", colon + 1);
        return first == std::string::npos ? "" : line.substr(first);
    }
    return "";
}

void keep_if_known(std::string& field, std::string value) {
    if (!value.empty())
        field = std::move(value);
}

std::optional<bool> flag_of(const path& file) {
    const std::string line = line_of(file);
    return line.empty() ? std::nullopt : std::optional(line != "0");
}

std::uint32_t usable_cores() {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        return static_cast<std::uint32_t>(std::max(1, CPU_COUNT(&set)));
    return std::max(1u, std::thread::hardware_concurrency()); // more than 1024 cores
}

/// From /sys, which knows what of a host's cache is ours, else by system call.
std::optional<std::uint64_t> cache_bytes(const path& root, int level, int name) {
    for (int i = 0; i < 8; ++i) {
        const path index =
            root / "sys/devices/system/cpu/cpu0/cache" / ("index" + std::to_string(i));
        if (line_of(index / "level") != std::to_string(level) ||
            line_of(index / "type") == "Instruction")
            continue;
        std::istringstream size(line_of(index / "size")); // "32K"
        std::uint64_t number = 0;
        char unit = 0;
        if (size >> number >> unit)
            return number << (unit == 'M' ? 20 : 10);
    }
    if (const long bytes = sysconf(name); bytes > 0)
        return static_cast<std::uint64_t>(bytes);
    return std::nullopt;
}

double steal_share(const path& root) {
    std::ifstream stat(root / "proc/stat");
    std::string word;
    stat >> word;
    double total = 0, steal = 0;
    // user nice system idle iowait irq softirq steal; guest times are counted in user already
    for (int i = 0; i < 8; ++i) {
        double ticks = 0;
        if (!(stat >> ticks))
            return 0;
        total += ticks;
        steal = ticks;
    }
    return total > 0 ? steal / total : 0;
}

std::string virtualisation(const path& root, const std::string& lscpu) {
    std::string virt = value_of(std::istringstream(lscpu), "Hypervisor vendor");
    if (virt.empty()) {
        const std::string flags =
            " " + value_of(std::ifstream(root / "proc/cpuinfo"), "flags") + " ";
        virt = flags.find(" hypervisor ") != std::string::npos ? "hypervisor" : "none";
    }
    if (exists(root / ".dockerenv") || exists(root / "run/.containerenv"))
        virt += " container";
    return virt;
}

/// "always [madvise] never" -> "madvise"
std::string chosen(const std::string& line) {
    const std::size_t open = line.find('['), close = line.find(']');
    return open < close && close != std::string::npos ? line.substr(open + 1, close - open - 1)
                                                      : "";
}

} // namespace

Machine read_machine(const std::string& lscpu, const path& root) {
    Machine m;
    utsname name;
    if (uname(&name) == 0) {
        m.host = name.nodename;
        m.kernel = std::string(name.sysname) + " " + name.release + " " + name.machine;
    }
    keep_if_known(m.cpu, value_of(std::istringstream(lscpu), "Model name"));
    keep_if_known(m.cpu, value_of(std::ifstream(root / "proc/cpuinfo"), "model name"));
    m.cores = usable_cores();

    std::istringstream quota(
        line_of(root / "sys/fs/cgroup/cpu.max")); // "200000 100000", "max 100000"
    if (double share = 0, period = 0; quota >> share >> period && period > 0)
        m.quota = share / period;

    m.l1d_bytes = cache_bytes(root, 1, _SC_LEVEL1_DCACHE_SIZE);
    m.l2_bytes = cache_bytes(root, 2, _SC_LEVEL2_CACHE_SIZE);
    m.l3_bytes = cache_bytes(root, 3, _SC_LEVEL3_CACHE_SIZE);

    std::istringstream memory(value_of(std::ifstream(root / "proc/meminfo"), "MemTotal"));
    if (std::uint64_t kilobytes = 0; memory >> kilobytes)
        m.memory_bytes = kilobytes << 10;

    const path cpus = root / "sys/devices/system/cpu";
    keep_if_known(m.governor, line_of(cpus / "cpu0/cpufreq/scaling_governor"));
    m.boost = flag_of(cpus / "cpufreq/boost");
    if (const auto no_turbo = flag_of(cpus / "intel_pstate/no_turbo"))
        m.boost = !*no_turbo;
    m.smt = flag_of(cpus / "smt/active");
    keep_if_known(m.thp, chosen(line_of(root / "sys/kernel/mm/transparent_hugepage/enabled")));
    m.virt = virtualisation(root, lscpu);
    std::ifstream(root / "proc/loadavg") >> m.load1;
    m.steal = steal_share(root);
    return m;
}

double triad_gbs(const Machine& machine, unsigned threads) {
    // STREAM prescribes arrays of four times the last cache; a quarter of the memory must do.
    constexpr std::uint64_t min_bytes = 32 << 20, max_bytes = 128 << 20;
    std::uint64_t bytes = std::clamp(4 * machine.l3_bytes.value_or(0), min_bytes, max_bytes);
    if (machine.memory_bytes)
        bytes = std::min(bytes, machine.memory_bytes / 12);
    const std::size_t n = bytes / sizeof(double);
    Buffer<double> a(n), b(n), c(n);

    // Each thread works on its own part, which it was first to touch.
    const auto on_parts = [&](auto&& work) {
        std::vector<std::jthread> others;
        for (unsigned t = 1; t < threads; ++t)
            others.emplace_back([&, t] { work(n * t / threads, n * (t + 1) / threads); });
        work(std::size_t{0}, n / threads);
    };
    on_parts([&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            a[i] = 0, b[i] = 1, c[i] = 2;
    });
    using Clock = std::chrono::steady_clock;
    double best_s = std::numeric_limits<double>::infinity();
    const auto end = Clock::now() + std::chrono::milliseconds(50);
    for (double s = 1; s < 4 || Clock::now() < end; ++s) {
        const auto start = Clock::now();
        on_parts([&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                a[i] = b[i] + s * c[i];
        });
        best_s = std::min(best_s, std::chrono::duration<double>(Clock::now() - start).count());
    }
    volatile double keep = a[n / 2]; // the writes must be seen to be needed
    static_cast<void>(keep);
    return static_cast<double>(3 * bytes) / best_s * 1e-9;
}

double core_ghz() {
    // Xorshift (Marsaglia 2003): three shifts and three exclusive ors, each waiting for the last.
    constexpr int rounds = 1'000'000, cycles_per_round = 6;
    using Clock = std::chrono::steady_clock;
    std::uint64_t x = 88172645463325252u;
    double best_ns = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < 10; ++pass) {
        const auto start = Clock::now();
        for (int i = 0; i < rounds; ++i) {
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
        }
        best_ns = std::min(best_ns,
                           std::chrono::duration<double, std::nano>(Clock::now() - start).count());
        volatile std::uint64_t keep = x;
        static_cast<void>(keep);
    }
    return rounds * cycles_per_round / best_ns;
}

} // namespace boxwood::bench
