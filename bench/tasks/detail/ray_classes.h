#pragma once

#include <string>
#include <vector>

/// The classes of contenders of rays: one ray in a call, answered before the next; or a batch that
/// is known as a whole. Batches are for ours in one call, and for peers in whatever they take:
/// single rays too, as many a user has nothing else, packets and streams.
namespace boxwood::bench::ray_class {

inline const std::string single = "single rays", batches = "batches";

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
