/// PLY files.

#include "bench/fuzz/mesh.h"

namespace boxwood::fuzz {

void mesh_ply(Bytes bytes) {
    static const ScratchFile file(".ply");
    read_mesh(file, bytes);
}

} // namespace boxwood::fuzz
