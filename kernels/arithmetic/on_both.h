#pragma once

/// Marks what a kernel on a CUDA device calls too. Only such functions may be called there: nvcc's
/// --expt-relaxed-constexpr, which would lift that, silently compiles some kernels to nothing.
#if defined(__CUDACC__)
#define BOXWOOD_BOTH __host__ __device__
#else
#define BOXWOOD_BOTH
#endif
