#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The instruction set as an axis of a sweep: our SIMD code and Embree choose theirs when they run,
/// and can be held to less than the processor has.
namespace boxwood::bench {

/// What cells can be held to: "baseline" (of processors before AVX2: Embree's SSE4.2, our scalar
/// code), "avx2", "avx512".
std::span<const std::string_view> instruction_sets();

/// Why code cannot be held to an instruction set here; nothing if it can, or for an empty name.
std::optional<std::string> missing_instruction_set(std::string_view name);

/// While one lives, our SIMD code in all threads uses no more than an instruction set; an empty
/// name holds it to nothing. One lives at a time.
class InstructionSetLimit {
  public:
    explicit InstructionSetLimit(std::string_view name);
    ~InstructionSetLimit();
    InstructionSetLimit(const InstructionSetLimit&) = delete;
    InstructionSetLimit& operator=(const InstructionSetLimit&) = delete;
};

/// Highway's name of what our SIMD code uses now, "AVX2"; all that the processor has, best first.
std::string isa_used();
std::vector<std::string> isas_supported();

} // namespace boxwood::bench
