#include "bench/commands/devices.h"

#include "bench/io/bad_input.h"
#include "bench/io/output_of.h"
#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace boxwood::bench {
namespace {

std::string cuda_version(int version) {
    return fmt::format("{}.{}", version / 1000, version % 1000 / 10);
}

/// The rows of the device, without the bus id that they begin with. nvidia-smi writes its domain
/// with eight digits, CUDA with four.
std::vector<std::vector<std::string>> rows_of(const Device& device, const std::string& text) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> fields;
        std::istringstream row(line);
        for (std::string field; std::getline(row >> std::ws, field, ',');)
            fields.push_back(field);
        const std::size_t colon = fields.empty() ? std::string::npos : fields[0].find(':');
        if (colon == std::string::npos || device.bus_id.empty() ||
            !fmt::format("0000{}", device.bus_id).ends_with(fields[0].substr(colon)))
            continue;
        fields.erase(fields.begin());
        rows.push_back(fields);
    }
    return rows;
}

Finding clocks(const Device& device, const DeviceUse& use) {
    const std::string name = device_name(device) + " clock";
    const auto rows = rows_of(device, use.clocks);
    if (rows.empty() || rows[0].size() < 3)
        return {Level::note, name, fmt::format("up to {:.2f} GHz", device.max_clock_ghz),
                "nvidia-smi, which shows the clock of now, was not found"};
    const std::string value = fmt::format("{} of {} MHz", rows[0][0], rows[0][1]);
    if (rows[0][2] == "Disabled")
        return {Level::note, name, value,
                "the driver is loaded for each process: nvidia-smi -pm 1 keeps it, and "
                "nvidia-smi -lgc fixes the clock"};
    return {Level::ok, name, value, ""};
}

Finding others(const Device& device, const DeviceUse& use) {
    const auto rows = rows_of(device, use.processes);
    const std::string name = device_name(device) + " other users";
    if (rows.empty())
        return {Level::ok, name, "none seen", ""};
    std::string text;
    for (const auto& row : rows)
        text += (text.empty() ? "process " : ", ") + row[0];
    return {Level::warn, name, text, "they share its time and memory: stop them before timing"};
}

} // namespace

std::string device_name(const Device& device) { return fmt::format("cuda:{}", device.index); }

std::string device_summary(const Device& device) {
    return fmt::format("{}: {} multiprocessors, {:.1f} GiB, sm_{}{}, driver {}, runtime {}",
                       device.name, device.multiprocessors,
                       static_cast<double>(device.memory_bytes) / (1 << 30),
                       device.capability_major, device.capability_minor,
                       cuda_version(device.driver), cuda_version(device.runtime));
}

int chosen_device(std::string_view name, std::span<const Device> there,
                  const std::string& why_none) {
    if (there.empty())
        throw BadInput(fmt::format("no device '{}': {}", name, why_none));
    std::vector<std::string> names;
    for (const Device& device : there) {
        if (name == device_name(device) || name == "cuda")
            return device.index;
        names.push_back(device_name(device));
    }
    throw BadInput(
        unknown_name("device", name, std::vector<std::string_view>(names.begin(), names.end())));
}

DeviceUse device_use() {
    const std::string format = " --format=csv,noheader,nounits 2>/dev/null";
    return {output_of("nvidia-smi --query-gpu=pci.bus_id,clocks.sm,clocks.max.sm,persistence_mode" +
                      format),
            output_of("nvidia-smi --query-compute-apps=gpu_bus_id,pid,used_memory" + format)};
}

std::vector<Finding> examine_devices(std::span<const Device> there, const std::string& why_none,
                                     const DeviceUse& use) {
    if (there.empty())
        return {{Level::note, "GPU", "none that CUDA can use", why_none}};
    std::vector<Finding> findings;
    for (const Device& device : there) {
        findings.push_back({Level::ok, device_name(device), device_summary(device), ""});
        findings.push_back(clocks(device, use));
        findings.push_back({device.ecc ? Level::ok : Level::note, device_name(device) + " ECC",
                            device.ecc ? "on" : "off",
                            device.ecc ? "" : "errors in its memory go unseen"});
        findings.push_back(others(device, use));
    }
    return findings;
}

} // namespace boxwood::bench
