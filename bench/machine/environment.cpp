#include "bench/machine/environment.h"

#include "bench/io/output_of.h"
#include "bench/machine/machine.h"
#include "bench/tasks/contender.h"
#include "bench/tasks/instruction_sets.h"
#include "build_info.h"
#include "cmake_cache.h"
#include "git_commit.h"
#include "trees/device.h"

#include <CLI/Version.hpp>
#include <fmt/format.h>
#include <hwy/highway.h>
#include <tbb/version.h>
#include <toml++/toml.h>
#include <xxhash.h>

#include <map>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace boxwood::bench {
namespace {

std::string highway_version() { return fmt::format("{}.{}.{}", HWY_MAJOR, HWY_MINOR, HWY_PATCH); }

std::string hash_of(const results::Env& e) {
    // A separator that no field holds keeps ("ab", "c") and ("a", "bc") apart.
    std::string text;
    const auto add = [&](const auto&... fields) { ((text += fmt::format("{}\x1f", fields)), ...); };
    add(e.host, e.cpu, e.ncpu, e.l1d_bytes, e.l2_bytes, e.l3_bytes, e.isa_max, e.isa_used);
    add(e.governor, e.thp, e.virt, e.kernel, e.mxcsr, e.memory_bytes, e.quota, e.boost, e.smt);
    if (!e.gpu.empty())
        add(e.gpu, e.gpu_sm, e.gpu_memory_bytes, e.gpu_driver);
    add(e.compiler, e.flags, e.build_type, e.git_commit, e.git_dirty);
    for (const auto& [name, version] : packages())
        add(name, version);
    return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

} // namespace

std::string cmake_cache_text() { return cmake_cache; }

std::string lscpu_text() { return output_of("LC_ALL=C lscpu 2>/dev/null"); }

std::string_view build_type() { return BOXWOOD_BUILD_TYPE; }
std::string_view sanitizers() { return BOXWOOD_SANITIZERS; }
std::string_view version() { return BOXWOOD_VERSION; }

std::string git_commit() {
    return BOXWOOD_GIT_COMMIT + std::string(BOXWOOD_GIT_DIRTY ? "-dirty" : "");
}

std::string compiler() {
#if defined(__clang__)
    return "clang++ " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}

std::vector<std::pair<std::string, std::string>> packages() {
    std::vector<std::pair<std::string, std::string>> list{
        {"highway", highway_version()},
        {"tbb", TBB_VERSION_STRING},
        {"eigen", BOXWOOD_EIGEN_VERSION},
        {"hdf5", BOXWOOD_HDF5_VERSION},
        {"google-benchmark", BOXWOOD_GBENCH_VERSION},
        {"assimp", BOXWOOD_ASSIMP_VERSION},
        {"xxhash", BOXWOOD_XXHASH_VERSION},
        {"fmt",
         fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
        {"cli11", CLI11_VERSION},
        {"tomlplusplus", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)}};
    for (const Peer& peer : peers())
        if (peer.name != "brute_force")
            list.emplace_back(peer.name, peer.version);
    for (const std::string_view name : absent_peers())
        list.emplace_back(name, "absent");
    return list;
}

std::vector<results::Package> package_rows() {
    static const std::map<std::string_view, std::string_view> revisions{BOXWOOD_PACKAGE_REVISIONS};
    static const std::map<std::string_view, std::string_view> flags{BOXWOOD_PEER_FLAGS};
    const auto of = [](const auto& texts, const std::string& name) {
        const auto found = texts.find(name);
        return found == texts.end() ? std::string{} : std::string(found->second);
    };
    std::vector<results::Package> rows;
    for (auto& [name, version] : packages()) {
        results::Package row;
        row.library = name;
        row.present = version != "absent";
        row.version = row.present ? version : "";
        for (const Peer& peer : peers())
            if (peer.name == name) {
                const std::string own = of(flags, name);
                row.build = fmt::format("{}; what is compiled here: {}{}", peer.build, own,
                                        own.find(" -m") == std::string::npos
                                            ? ", for the baseline instruction set (no -m)"
                                            : "");
            }
        if (row.present)
            row.revision = of(revisions, name);
        rows.push_back(row);
    }
    return rows;
}

std::uint32_t mxcsr() {
#if defined(__SSE__)
    return _mm_getcsr();
#else
    return 0;
#endif
}

bool ieee_arithmetic() {
    // Rounding control (bits 13, 14), flush to zero (15) and denormals are zero (6).
    return (mxcsr() & 0xe040u) == 0;
}

results::Env environment(bool measure_bandwidth) {
    const Machine machine = read_machine(lscpu_text());
    results::Env e;
    e.host = machine.host;
    e.cpu = machine.cpu;
    e.ncpu = machine.cores;
    e.l1d_bytes = machine.l1d_bytes.value_or(results::no_count);
    e.l2_bytes = machine.l2_bytes.value_or(results::no_count);
    e.l3_bytes = machine.l3_bytes.value_or(results::no_count);
    e.isa_max = isas_supported().at(0);
    e.isa_used = isa_used();
    e.memory_bytes = machine.memory_bytes ? machine.memory_bytes : results::no_count;
    e.quota = machine.quota.value_or(results::missing);
    e.boost = machine.boost ? *machine.boost : results::no_id;
    e.smt = machine.smt ? *machine.smt : results::no_id;
    e.governor = machine.governor;
    e.thp = machine.thp;
    e.virt = machine.virt;
    e.kernel = machine.kernel;
    e.mxcsr = mxcsr() & ~0x3fu; // without the sticky exception flags
    e.compiler = compiler();
    e.flags = BOXWOOD_CXX_FLAGS;
    e.build_type = BOXWOOD_BUILD_TYPE;
    e.git_commit = BOXWOOD_GIT_COMMIT;
    e.git_dirty = BOXWOOD_GIT_DIRTY;
    if (const std::vector<Device> there = devices(); !there.empty()) {
        const Device& device = there.front(); // which all device cells run on
        e.gpu = device.name;
        e.gpu_sm = device.multiprocessors;
        e.gpu_memory_bytes = device.memory_bytes;
        e.gpu_driver = fmt::format("{}.{}", device.driver / 1000, device.driver % 1000 / 10);
        e.gpu_clock_ghz = device.max_clock_ghz;
        e.gpu_l2_bytes = device.cache_bytes;
    }
    if (measure_bandwidth) {
        e.stream_triad_gbs_1 = triad_gbs(machine, 1);
        e.stream_triad_gbs_all = triad_gbs(machine, machine.cores);
        e.core_ghz = core_ghz();
    }
    e.env_hash = hash_of(e);
    return e;
}

} // namespace boxwood::bench
