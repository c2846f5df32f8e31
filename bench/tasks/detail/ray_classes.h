#pragma once

#include <string>
#include <vector>

/// The classes of contenders of rays. A peer takes single rays, or packets and streams. Ours
/// answers a batch in one call: it stands against packets, and against single rays for what a batch
/// gains over them.
namespace boxwood::bench::ray_class {

inline const std::string single = "single rays", batches = "batches", packets = "packets";

/// Watertight contenders stand by themselves.
inline std::vector<std::string> watertight(std::vector<std::string> classes) {
    for (std::string& name : classes)
        name = "watertight " + name;
    return classes;
}

/// Ours with the watertight kernel also stands in the looser class.
inline std::vector<std::string> of_ours(std::vector<std::string> classes,
                                        const std::string& kernel) {
    if (kernel == "watertight")
        for (const std::string& name : watertight(classes))
            classes.push_back(name);
    return classes;
}

} // namespace boxwood::bench::ray_class
