/// `query rays` at a cube: two trees print the same, or refuse the same.

#include "bench/fuzz/csv.h"

namespace boxwood::fuzz {
namespace {

constexpr std::string_view cube = R"(v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 2 3
f 1 3 4
f 5 7 6
f 5 8 7
f 1 6 2
f 1 5 6
f 4 3 7
f 4 7 8
f 1 4 8
f 1 8 5
f 2 6 7
f 2 7 3
)";

} // namespace

void ray_csv(Bytes bytes) {
    static const ScratchFile mesh(".obj"), file(".csv");
    static const std::string mesh_path =
        mesh.holding({reinterpret_cast<const std::uint8_t*>(cube.data()), cube.size()}).string();
    bench::RaysQuery query;
    query.mesh = mesh_path;
    query.rays = file.holding(bytes).string();
    query.kernel = "exact";
    query.tree = tree_of("binned_sah", "wide8");
    const auto first = printed(query);
    query.tree = tree_of("median", "binary");
    require(printed(query) == first, "two trees print different hits");
}

} // namespace boxwood::fuzz
