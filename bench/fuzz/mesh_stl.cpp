/// STL files.

#include "bench/fuzz/mesh.h"

namespace boxwood::fuzz {

void mesh_stl(Bytes bytes) {
    static const ScratchFile file(".stl");
    read_mesh(file, bytes);
}

} // namespace boxwood::fuzz
