#pragma once

#include <cstdint>
#include <utility>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace boxwood {

/// The bits of this thread's floating-point control word that replace denormals by zero, in results
/// (FTZ) or operands (DAZ): MXCSR on x86-64, FPCR on AArch64. Elsewhere there are none.
namespace float_mode {

#if defined(__SSE2__)
using Word = std::uint32_t;
inline constexpr Word flushing = 0x8040; // FTZ, DAZ
inline Word get() { return _mm_getcsr(); }
inline void set(Word word) { _mm_setcsr(word); }
#elif defined(__aarch64__)
using Word = std::uint64_t;
inline constexpr Word flushing = 0x1000001; // FZ, FIZ
inline Word get() {
    Word word;
    asm volatile("mrs %0, fpcr" : "=r"(word));
    return word;
}
inline void set(Word word) { asm volatile("msr fpcr, %0" : : "r"(word)); }
#else
using Word = std::uint32_t;
inline constexpr Word flushing = 0;
inline Word get() { return 0; }
inline void set(Word) {}
#endif

} // namespace float_mode

inline bool flushes_denormals() { return (float_mode::get() & float_mode::flushing) != 0; }

/// Turns the flushing of denormals on or off in this thread while it lives; the other bits of the
/// control word (exceptions that were raised, the rounding mode) are left alone.
class DenormalFlushing {
  public:
    explicit DenormalFlushing(bool on) : before_(float_mode::get() & float_mode::flushing) {
        put(on ? float_mode::flushing : 0);
    }
    ~DenormalFlushing() { put(before_); }
    DenormalFlushing(const DenormalFlushing&) = delete;
    DenormalFlushing& operator=(const DenormalFlushing&) = delete;

  private:
    static void put(float_mode::Word bits) {
        float_mode::set((float_mode::get() & ~float_mode::flushing) | bits);
    }
    float_mode::Word before_;
};

/// A call that the compiler does not see through: it moves no arithmetic of f out of it.
template <class F>
#if defined(__clang__)
[[gnu::noinline]] [[clang::optnone]]
#else
[[gnu::noipa]]
#endif
decltype(auto)
call_opaquely(F& f) {
    return f();
}

/// f(), with denormals kept whatever the caller's mode, which is restored. Reads the mode (a few
/// cycles) and calls f directly if nothing is flushed. f must compute in it all that it relies on,
/// from values it was handed (not from results computed outside).
template <class F> decltype(auto) without_flushing(F&& f) {
    if (!flushes_denormals()) [[likely]]
        return f();
    const DenormalFlushing off(false);
    return call_opaquely(f);
}

} // namespace boxwood
