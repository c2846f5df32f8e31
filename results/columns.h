#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Tables that others wrote: of any HDF5 file, not of ours alone.
namespace boxwood::results {

/// Whether the file begins as HDF5 files do; false if it cannot be read.
bool is_hdf5(const std::filesystem::path& file);

/// Columns of numbers, equally long, in the order of `columns`; others are skipped. `table` is a
/// compound dataset (h5py; pandas in its format "table"), or a group with a dataset of each column.
/// Integers above 2^53 are rounded. Throws std::runtime_error, "FILE: cause and what to do", for a
/// file, table or column that is missing, is none, or holds no numbers.
std::vector<std::vector<double>> read_columns(const std::filesystem::path& file,
                                              const std::string& table,
                                              std::span<const std::string_view> columns);

} // namespace boxwood::results
