#pragma once

/// Marks what a kernel on a CUDA device calls too. Only such functions may be called there: nvcc's
/// --expt-relaxed-constexpr, which would lift that, silently compiles some kernels to nothing.
#if defined(__CUDACC__)
#define BOXWOOD_BOTH __host__ __device__
#else
#define BOXWOOD_BOTH
#endif

#include <cstring>

namespace boxwood {

/// std::bit_cast, which a device cannot call.
template <class To, class From> BOXWOOD_BOTH To bits_as(From from) {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    memcpy(&to, &from, sizeof to);
    return to;
}

} // namespace boxwood
