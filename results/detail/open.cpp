#include "results/detail/open.h"

namespace boxwood::results::detail {

namespace fs = std::filesystem;

void require_file(const fs::path& file) {
    if (!fs::exists(file))
        throw std::runtime_error("no such file");
    if (!fs::is_regular_file(file))
        throw std::runtime_error("not a regular file");
    if (fs::file_size(file) == 0)
        throw std::runtime_error("the file is empty");
}

Handle open_to_read(const fs::path& file) {
    if (checked(H5Fis_hdf5(file.c_str()), "opening it") == 0)
        throw std::runtime_error("not an HDF5 file, or cut off within its first bytes");
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access");
    checked(H5Pset_fapl_core(access, /*increment=*/4096, /*backing_store=*/false), "file access");
    return Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), H5Fclose,
                  "not a readable HDF5 file");
}

} // namespace boxwood::results::detail
