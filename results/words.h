#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// What has few values: enums in the program, words on disk.
namespace boxwood::results {

/// What is timed. The last two are sums of one round: what one use costs.
enum class Phase : std::uint8_t {
    none,
    build,
    cold_build,
    update,
    query,
    cold_query,
    upload,
    device_build,
    device_query,
    download,
    build_and_query,
    update_and_query,
    cold_build_and_query
};
/// The answer of a cell, the worst of its checks and rounds.
enum class Status : std::uint8_t {
    unchecked,
    exact,
    conservative,
    within_bound,
    unsupported,
    wrong
};
/// Cell b against cell a.
enum class Verdict : std::uint8_t { none, faster, slower, same, cannot_tell, wrong };
/// Why a verdict is cannot_tell.
enum class Reason : std::uint8_t {
    none,
    too_few_rounds,
    below_the_floor,
    crosses_1,
    unchecked,
    too_noisy,
    memory_layout ///< it flips with the size of the environment, by which memory is laid out
};
/// Which claims were corrected together; analysis/comparisons.h says how each is formed.
enum class Family : std::uint8_t { none, peers, ours, threads, stages, devices, errors };
/// What a row of findings is about.
enum class Topic : std::uint8_t { none, race, call, kernel, scene, device };

/// Of Variant::stages; any other word is the effect that the scene is played without.
inline constexpr std::string_view required_stages = "required", all_stages = "all";
/// Of Variant::name of a contender whose answers may err: before the error, at the end.
inline constexpr std::string_view error_mark = ".within_";
/// ... of those whose bounds are not certified: "obb.distance.plain".
inline constexpr std::string_view plain_mark = ".plain";
/// Of Cell::executor on a device: from the host's boxes to the host's answers; all stays there; so,
/// and started by one launch.
inline constexpr std::string_view device_executor = "cuda", resident_executor = "cuda_resident",
                                  graph_executor = "cuda_graph";
constexpr bool is_of_device(std::string_view executor) {
    return executor == device_executor || executor == resident_executor ||
           executor == graph_executor;
}

template <class Enum> struct Words;
template <> struct Words<Phase> {
    static constexpr std::array<std::string_view, 13> all{"",
                                                          "build",
                                                          "cold_build",
                                                          "update",
                                                          "query",
                                                          "cold_query",
                                                          "upload",
                                                          "device_build",
                                                          "device_query",
                                                          "download",
                                                          "build+query",
                                                          "update+query",
                                                          "cold_build+query"};
};
template <> struct Words<Status> {
    static constexpr std::array<std::string_view, 6> all{
        "unchecked", "exact", "conservative", "within_bound", "unsupported", "wrong"};
};
template <> struct Words<Verdict> {
    static constexpr std::array<std::string_view, 6> all{"",     "faster",      "slower",
                                                         "same", "cannot_tell", "wrong"};
};
template <> struct Words<Reason> {
    static constexpr std::array<std::string_view, 7> all{
        "",          "too_few_rounds", "below_the_floor", "crosses_1",
        "unchecked", "too_noisy",      "memory_layout"};
};
template <> struct Words<Family> {
    static constexpr std::array<std::string_view, 7> all{"",       "peers",   "ours",  "threads",
                                                         "stages", "devices", "errors"};
};
template <> struct Words<Topic> {
    static constexpr std::array<std::string_view, 6> all{"",       "race",  "call",
                                                         "kernel", "scene", "device"};
};

/// An enum that has words.
template <class Enum>
concept Worded = requires {
    Words<Enum>::all;
};

template <Worded Enum> constexpr std::string_view to_string(Enum value) {
    return Words<Enum>::all[static_cast<std::size_t>(value)];
}

} // namespace boxwood::results
