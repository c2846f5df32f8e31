#include "bench/commands/doctor.h"

#include "bench/commands/command.h"
#include "bench/commands/devices.h"
#include "bench/io/bad_input.h"
#include "bench/io/json.h"
#include "bench/io/text_table.h"
#include "bench/io/write_file.h"
#include "bench/machine/environment.h"
#include "bench/tasks/contender.h"
#include "bench/tasks/instruction_sets.h"
#include "scenes/meshes/mesh_file.h"
#include "trees/queries/sides.h"
#include "trees/world/mesh_triage.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <system_error>

namespace boxwood::bench {
namespace {

std::string_view to_string(Level level) {
    return level == Level::ok ? "ok" : level == Level::note ? "note" : "warn";
}

std::string size_text(std::optional<std::uint64_t> bytes) {
    return bytes ? bytes_text(*bytes) : "unknown";
}

Finding cores(const Machine& m) {
    if (m.quota && *m.quota < m.cores)
        return {Level::warn, "cores",
                fmt::format("{}, limited to {:.2g} by the container", m.cores, *m.quota),
                "raise the container's CPU limit, or time with fewer threads than the limit"};
    if (m.cores < 4)
        return {Level::note, "cores", fmt::format("{}", m.cores),
                "how times scale to more threads cannot be measured here"};
    return {Level::ok, "cores", fmt::format("{}", m.cores), ""};
}

Finding governor(const Machine& m) {
    if (m.governor == "performance")
        return {Level::ok, "clock governor", m.governor, ""};
    if (m.governor == "unknown")
        return {Level::note, "clock governor", "not visible here",
                "on real hardware: cpupower frequency-set -g performance"};
    return {Level::warn, "clock governor", m.governor,
            "the clock follows the load: cpupower frequency-set -g performance"};
}

Finding boost(const Machine& m) {
    if (!m.boost)
        return {Level::note, "clock boost", "not visible here",
                "the clock may change with heat; compare within one run only"};
    if (!*m.boost)
        return {Level::ok, "clock boost", "off", ""};
    return {Level::note, "clock boost", "on",
            "the clock rises while few cores are busy; for steady times write 1 to "
            "/sys/devices/system/cpu/intel_pstate/no_turbo or 0 to "
            "/sys/devices/system/cpu/cpufreq/boost"};
}

Finding smt(const Machine& m) {
    if (!m.smt)
        return {Level::note, "hyper-threads", "not visible here", ""};
    if (!*m.smt)
        return {Level::ok, "hyper-threads", "none or off", ""};
    return {
        Level::note, "hyper-threads", "on",
        "two threads may share a core: read thread scaling beyond half the threads with care, or "
        "write off to /sys/devices/system/cpu/smt/control"};
}

Finding virtualisation(const Machine& m) {
    if (m.virt == "none")
        return {Level::ok, "virtual machine", "none", ""};
    return {
        Level::note, "virtual machine", m.virt,
        "neighbours may disturb timings; more rounds help, and the run flags what was disturbed"};
}

Finding load(const Machine& m) {
    const std::string value = fmt::format("{:.2f} running processes in the last minute", m.load1);
    if (m.load1 < 0.3)
        return {Level::ok, "load", value, ""};
    return {m.load1 < 0.8 ? Level::note : Level::warn, "load", value,
            "stop other work before timing (top shows it)"};
}

Finding steal(const Machine& m) {
    const std::string value = fmt::format("{:.2f} % of the time since boot", 100 * m.steal);
    if (m.steal < 0.001)
        return {Level::ok, "stolen time", value, ""};
    return {m.steal < 0.02 ? Level::note : Level::warn, "stolen time", value,
            "the hypervisor runs others on these cores; use a machine with dedicated cores"};
}

Finding huge_pages(const Machine& m) {
    if (m.thp == "always")
        return {Level::note, "transparent huge pages", m.thp,
                "when pages are merged depends on the memory's history; madvise is steadier"};
    return {m.thp == "unknown" ? Level::note : Level::ok, "transparent huge pages", m.thp, ""};
}

/// All that was found, to be written as text or JSON.
struct Examination {
    Machine machine = read_machine(lscpu_text());
    double triad_one = triad_gbs(machine, 1), triad_all = triad_gbs(machine, machine.cores);
    std::vector<Finding> findings = examine(machine);

    Examination() {
        const std::vector<Device> gpus = devices();
        for (auto more :
             {examine_program(), examine_disk("."),
              examine_devices(gpus, why_no_device(), gpus.empty() ? DeviceUse{} : device_use())})
            std::move(more.begin(), more.end(), std::back_inserter(findings));
    }
};

std::string as_text(const Examination& r) {
    const Machine& m = r.machine;
    std::string text = fmt::format(
        "This machine\n  {}, {}\n  caches: L1d {}, L2 {}, L3 {}; memory {}\n"
        "  memory bandwidth (triad): {:.1f} GB/s on one thread, {:.1f} on all {}\n",
        m.cpu, m.kernel, size_text(m.l1d_bytes), size_text(m.l2_bytes), size_text(m.l3_bytes),
        size_text(m.memory_bytes), r.triad_one, r.triad_all, m.cores);
    text += "\nWhat may spoil timings\n";
    for (const Finding& f : r.findings) {
        text += fmt::format("  {:<4}  {}: {}\n", to_string(f.level), f.name, f.value);
        if (!f.advice.empty())
            text += fmt::format("        {}\n", f.advice);
    }
    text += fmt::format("\nInstruction sets\n  used: {} (supported: {})\n", isa_used(),
                        fmt::join(isas_supported(), ", "));
    text += "\nPeers\n";
    for (const Peer& peer : peers())
        text += fmt::format("  {} {} ({})\n", peer.name, peer.version, peer.build);
    for (const std::string_view name : absent_peers())
        text += fmt::format("  {}: absent, it was not found when boxwood was built "
                            "(bench/peers/README.md says how to get it)\n",
                            name);
    text += fmt::format("\nThis program\n  boxwood {}, commit {}, {}, {}\n", version(),
                        git_commit(), compiler(), build_type());
    text += "  packages:";
    for (const auto& [name, number] : packages())
        text += fmt::format(" {} {},", name, number);
    text.back() = '\n';

    const auto warnings = std::ranges::count(r.findings, Level::warn, &Finding::level);
    return text + (warnings ? fmt::format("\n{} warning{}: timings from here need care.\n",
                                          warnings, warnings == 1 ? "" : "s")
                            : "\nNo warnings.\n");
}

std::string as_json(const Examination& r) {
    const Machine& m = r.machine;
    std::string findings, isas, found, package_list;
    for (const Finding& f : r.findings)
        findings += fmt::format("{}{{\"level\":{},\"name\":{},\"value\":{},\"advice\":{}}}",
                                findings.empty() ? "" : ",\n  ", json_string(to_string(f.level)),
                                json_string(f.name), json_string(f.value), json_string(f.advice));
    for (const std::string& isa : isas_supported())
        isas += (isas.empty() ? "" : ",") + json_string(isa);
    for (const Peer& peer : peers())
        found += fmt::format("{}{{\"name\":{},\"present\":true,\"version\":{},\"build\":{}}}",
                             found.empty() ? "" : ",", json_string(peer.name),
                             json_string(peer.version), json_string(peer.build));
    for (const std::string_view name : absent_peers())
        found += fmt::format("{}{{\"name\":{},\"present\":false}}", found.empty() ? "" : ",",
                             json_string(name));
    for (const auto& [name, number] : packages())
        package_list += fmt::format("{}{}:{}", package_list.empty() ? "" : ",", json_string(name),
                                    json_string(number));
    return fmt::format("{{\"version\":{},\"commit\":{},\"compiler\":{},\"build_type\":{},\n"
                       " \"cpu\":{},\"cores\":{},\"kernel\":{},\"memory_bytes\":{},\n"
                       " \"triad_gbs\":{{\"one\":{},\"all\":{}}},\n"
                       " \"isa\":{{\"used\":{},\"supported\":[{}]}},\n"
                       " \"findings\":[\n  {}],\n \"peers\":[{}],\n \"packages\":{{{}}}}}\n",
                       json_string(version()), json_string(git_commit()), json_string(compiler()),
                       json_string(build_type()), json_string(m.cpu), m.cores,
                       json_string(m.kernel), m.memory_bytes, json_number(r.triad_one),
                       json_number(r.triad_all), json_string(isa_used()), isas, findings, found,
                       package_list);
}

} // namespace

std::vector<Finding> examine(const Machine& m) {
    return {cores(m),          governor(m), boost(m), smt(m),
            virtualisation(m), load(m),     steal(m), huge_pages(m)};
}

std::vector<Finding> examine_program() {
    std::vector<Finding> findings;
    const bool optimised = build_type() == "Release" || build_type() == "RelWithDebInfo";
    findings.push_back({optimised ? Level::ok : Level::warn, "build type",
                        std::string(build_type()),
                        optimised ? "" : "time the release preset: cmake --preset release"});
    if (!sanitizers().empty())
        findings.push_back({Level::warn, "sanitizers", std::string(sanitizers()),
                            "they slow code many times: time the release preset"});
    findings.push_back({ieee_arithmetic() ? Level::ok : Level::warn, "floating point",
                        fmt::format("MXCSR {:#06x}", mxcsr() & ~0x3fu),
                        ieee_arithmetic() ? ""
                                          : "subnormals are flushed or rounding is not to nearest: "
                                            "exact answers may be wrong; look for a library built "
                                            "with -ffast-math in LD_PRELOAD"});
    return findings;
}

std::vector<Finding> examine_disk(const std::filesystem::path& folder) {
    std::error_code error;
    const auto space = std::filesystem::space(folder, error);
    if (error)
        return {{Level::warn, "free disk", error.message(), "results are written here by default"}};
    const bool enough = space.available > (std::uintmax_t{1} << 30);
    return {{enough ? Level::ok : Level::warn, "free disk",
             fmt::format("{:.1f} GB in this folder", static_cast<double>(space.available) * 1e-9),
             enough ? "" : "a full sweep may fill it; free some, or give --out another folder"}};
}

std::string doctor(bool json) { return json ? as_json(Examination()) : as_text(Examination()); }

namespace {

/// "3 (the first: triangle 17)"
std::string some(const std::vector<std::uint32_t>& triangles) {
    return triangles.empty()
               ? "0"
               : fmt::format("{} (the first: triangle {})", triangles.size(), triangles.front());
}

} // namespace

std::string doctor_of_mesh(const TriangleMesh& mesh, const std::string& file, bool json) {
    const MeshTriage found = triage(mesh);
    // As --solid and contains see it.
    const bool may_be_solid = found.not_finite.empty() && open_edges(mesh) == 0;
    if (json)
        return fmt::format(
            "{{\"triangles\":{},\"vertices\":{},\"not_finite\":{},\"too_large\":{},\"without_"
            "area\":{},\"repeated\":"
            "{},\"open_edges\":"
            "{},"
            "\"non_manifold_edges\":{},\"turned_edges\":{},\"is_closed\":{},\"is_clean\":{}}}\n",
            found.triangles, found.vertices, found.not_finite.size(), found.too_large.size(),
            found.without_area.size(), found.repeated.size(), found.open_edges,
            found.non_manifold_edges, found.turned_edges, may_be_solid, found.is_clean());
    std::string text =
        fmt::format("{}: {} triangles, {} vertices (those at one place counted once)\n", file,
                    found.triangles, found.vertices);
    text += fmt::format("  triangles with a NaN or inf  {}\n", some(found.not_finite));
    text += fmt::format("  triangles beyond 2^60        {}\n", some(found.too_large));
    text += fmt::format("  triangles without area       {}\n", some(found.without_area));
    text += fmt::format("  triangles that are repeated  {}\n", some(found.repeated));
    text += fmt::format("  open edges                   {}\n", found.open_edges);
    text += fmt::format("  edges of three and more      {}\n", found.non_manifold_edges);
    text += fmt::format("  edges wound both ways        {}\n", found.turned_edges);
    text += may_be_solid && !found.too_large.empty() ? "It is closed.\n"
            : may_be_solid ? "It is closed: it may be a solid (query collide --solid).\n"
            : found.is_closed()
                ? "It is closed but for its bad triangles (NaN or inf, without area, repeated): "
                  "without them (--out FILE.obj) it may be a solid.\n"
                : "It is not closed: it is a surface, and no solid.\n";
    if (!found.too_large.empty())
        text += "What is beyond 2^60 cannot be held against other bodies (query collide, distance, "
                "...): give it another unit.\n";
    return text;
}

void write_good_triangles(const TriangleMesh& mesh, const std::string& out) {
    if (std::filesystem::exists(out))
        throw BadInput(fmt::format("--out {}: is there already; name a new file", out));
    const TriangleMesh good = without_bad_triangles(mesh, triage(mesh));
    std::string text;
    for (const Vec3<float>& v : good.vertices)
        text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
    for (const auto& [a, b, c] : good.triangles)
        text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    write_file(out, text, "--out " + out);
}

void add_doctor(CLI::App& app, int&) {
    auto json = std::make_shared<bool>(false);
    auto mesh = std::make_shared<std::string>();
    auto out = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand(
        "doctor", "what on this machine will spoil timings, and which peers were found; or what is "
                  "wrong with a mesh");
    auto* of_mesh = command->add_option(
        "MESH", *mesh, "a mesh file: its triangles and edges are looked at instead");
    command
        ->add_option(
            "--out", *out,
            "write the mesh without its bad triangles as an OBJ file, the others as they are")
        ->needs(of_mesh);
    command->add_flag("--json", *json, "print one JSON object");
    command->footer("It changes nothing; each note and warning says what you could do.\n"
                    "Examples:\n  boxwood doctor\n  boxwood doctor gripper.stl\n"
                    "  boxwood doctor gripper.stl --out good.obj");
    command->callback([json, mesh, out] {
        if (mesh->empty()) {
            std::cout << doctor(*json);
            return;
        }
        const TriangleMesh looked_at = load_mesh(*mesh, NotFinite::keep);
        std::cout << doctor_of_mesh(looked_at, *mesh, *json);
        if (!out->empty())
            write_good_triangles(looked_at, *out);
    });
}

} // namespace boxwood::bench
