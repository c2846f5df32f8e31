#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace boxwood::bench {

/// What the operating system says about the machine now. Text is "unknown" where it says nothing.
struct Machine {
    std::string host = "unknown", kernel = "unknown"; ///< "Linux 6.1.0 x86_64"
    std::string cpu = "unknown";                      ///< model name
    std::uint32_t cores = 1;                          ///< hardware threads this process may use
    std::optional<double> quota;                      ///< a container's limit, in cores
    std::optional<std::uint64_t> l1d_bytes, l2_bytes, l3_bytes; ///< of one instance
    std::uint64_t memory_bytes = 0;
    std::string governor = "unknown"; ///< of the first core's clock
    std::optional<bool> boost;        ///< whether the clock may rise above its base
    std::optional<bool> smt;          ///< whether two hardware threads share a core
    std::string thp = "unknown";      ///< transparent huge pages: always | madvise | never
    std::string virt = "none";        ///< "KVM", "hypervisor", "none", with " container" in one
    double load1 = 0;                 ///< mean number of running processes, last minute
    double steal = 0;                 ///< share of time since boot that a hypervisor took away
};

/// Reads /proc and /sys below `root`, and what only system calls tell (host, kernel, cores).
/// `lscpu` is the text of `lscpu_text()`, for the name of the hypervisor.
Machine read_machine(const std::string& lscpu, const std::filesystem::path& root = "/");

/// Memory bandwidth in GB/s (1e9 bytes) of a[i] = b[i] + s * c[i] over arrays of doubles beyond the
/// caches, by the number of threads; 24 bytes per element as STREAM counts them. The best of
/// several passes, about 0.1 s and 0.4 GB of memory.
double triad_gbs(const Machine& machine, unsigned threads);

/// The clock of this core while it is busy, in GHz: from a chain of operations of one cycle each,
/// the best of several, about 20 ms.
double core_ghz();

} // namespace boxwood::bench
