#include "trees/cuda/device/machine.h"

#include <charconv>

namespace boxwood::cuda {
namespace {

std::string version_text(int version) {
    return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

} // namespace

std::string why_none(int driver, int runtime, int n_devices) {
    if (driver == 0)
        return "no driver: install NVIDIA's for CUDA " + version_text(runtime) +
               " or newer (nvidia-smi shows it), or start the container with the GPU";
    if (driver < runtime)
        return "the driver is for CUDA " + version_text(driver) + ", older than the runtime " +
               version_text(runtime) + " that this program was built with: update the driver, or " +
               "build with an nvcc of CUDA " + version_text(driver);
    if (n_devices == 0)
        return "the driver shows no device: see nvidia-smi and CUDA_VISIBLE_DEVICES";
    return "";
}

bool runs_on(std::string_view architectures, int major, int minor) {
    const int device = 10 * major + minor;
    for (std::size_t begin = 0; begin < architectures.size();) {
        const std::size_t end = std::min(architectures.find(',', begin), architectures.size());
        const std::string_view one = architectures.substr(begin, end - begin);
        begin = end + 1;
        int code = 0;
        const auto [rest, error] = std::from_chars(one.data(), one.data() + one.size(), code);
        if (error != std::errc())
            return true; // native, all: whoever wrote it knows
        const std::string_view kind(rest, static_cast<std::size_t>(one.data() + one.size() - rest));
        const bool real = kind != "-virtual", is_virtual = kind != "-real";
        if ((real && code / 10 == major && code <= device) || (is_virtual && code <= device))
            return true;
    }
    return false;
}

} // namespace boxwood::cuda
