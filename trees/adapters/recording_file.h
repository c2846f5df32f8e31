#pragma once

/// Compiled by whoever includes it and has HDF5; not part of trees.h.

#include "trees/adapters/recording.h"

#include <hdf5.h>

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxwood {

/// Meanwhile HDF5 prints nothing of its own: failures are reported by what is thrown. One thread at
/// a time has one, as HDF5 may be built without threads.
class QuietHdf5 {
  public:
    QuietHdf5() {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    QuietHdf5(const QuietHdf5&) = delete;
    QuietHdf5& operator=(const QuietHdf5&) = delete;
    ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

  private:
    friend class Forks;
    static inline std::recursive_mutex one_at_a_time_;
    const std::lock_guard<std::recursive_mutex> lock_{one_at_a_time_};
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

/// How often this process has been forked, as a child of its parents. Nothing is forked while a
/// recording is written, so that HDF5 has nothing left to write of it in a child.
class Forks {
  public:
    static unsigned count() {
        static const int is_registered = pthread_atfork(
            [] { QuietHdf5::one_at_a_time_.lock(); }, [] { QuietHdf5::one_at_a_time_.unlock(); },
            [] { // whose thread is not the one that locked
                std::construct_at(&QuietHdf5::one_at_a_time_);
                ++n_;
            });
        static_cast<void>(is_registered);
        return n_;
    }

  private:
    static inline std::atomic<unsigned> n_ = 0;
};

/// The tables of a recording, which grow. What was flushed is
/// readable if the program ends badly later, but while it writes.
class RecordingFile {
  public:
    /// Throws std::runtime_error, "FILE: ...", if it cannot be made. What was there is lost.
    explicit RecordingFile(const std::filesystem::path& path) : path_(path.string()) {
        const QuietHdf5 quiet;
        file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
        check(file_);
    }
    RecordingFile(const RecordingFile&) = delete;
    RecordingFile& operator=(const RecordingFile&) = delete;
    ~RecordingFile() {
        const QuietHdf5 quiet;
        H5Fclose(file_);
    }

    class Table {
      public:
        Table(RecordingFile& file, std::string_view name, std::span<const std::string_view> columns)
            : file_(file), columns_(columns.size()) {
            const QuietHdf5 quiet;
            const std::string group(name);
            const hid_t made =
                H5Gcreate2(file.file_, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
            file.check(made);
            for (std::size_t i = 0; i < columns.size(); ++i)
                columns_[i].set = make_column(made, std::string(columns[i]));
            H5Gclose(made);
            for (const Column& column : columns_)
                if (column.set < 0) {
                    close();
                    file.check(column.set);
                }
        }
        Table(const Table&) = delete;
        Table& operator=(const Table&) = delete;
        ~Table() {
            const QuietHdf5 quiet;
            close();
        }

        void add(std::span<const double> row) {
            for (std::size_t i = 0; i < columns_.size(); ++i)
                columns_[i].unwritten.push_back(row[i]);
        }
        std::size_t n_unwritten() const { return columns_[0].unwritten.size(); }
        void add(std::initializer_list<double> row) { add(std::span(row.begin(), row.size())); }
        /// To be flushed at once: HDF5 keeps a part of it.
        void write() {
            const QuietHdf5 quiet;
            for (Column& column : columns_)
                column.write(file_);
        }

      private:
        void close() {
            for (const Column& column : columns_)
                if (column.set >= 0)
                    H5Dclose(column.set);
        }

        struct Column {
            hid_t set = -1;
            hsize_t n_written = 0;
            std::vector<double> unwritten;

            void write(const RecordingFile& file) {
                if (unwritten.empty())
                    return;
                const hsize_t n = unwritten.size(), all = n_written + n;
                file.check(H5Dset_extent(set, &all));
                const hid_t in_file = H5Dget_space(set),
                            in_memory = H5Screate_simple(1, &n, nullptr);
                herr_t done =
                    H5Sselect_hyperslab(in_file, H5S_SELECT_SET, &n_written, nullptr, &n, nullptr);
                if (done >= 0)
                    done = H5Dwrite(set, H5T_NATIVE_DOUBLE, in_memory, in_file, H5P_DEFAULT,
                                    unwritten.data());
                H5Sclose(in_memory);
                H5Sclose(in_file);
                file.check(done);
                n_written = all;
                unwritten.clear();
            }
        };
        RecordingFile& file_;
        std::vector<Column> columns_;
    };

    void flush() const {
        const QuietHdf5 quiet;
        check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    }

  private:
    static constexpr hsize_t rows_at_once = 16384;

    void check(hid_t done) const {
        if (done < 0)
            throw std::runtime_error(path_ + ": the recording cannot be written; is there such a "
                                             "folder, and space on the disk?");
    }
    /// Below 0 if it cannot be made.
    static hid_t make_column(hid_t group, const std::string& name) {
        const hsize_t none = 0, unlimited = H5S_UNLIMITED;
        const hid_t space = H5Screate_simple(1, &none, &unlimited);
        const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_chunk(how, 1, &rows_at_once);
        H5Pset_shuffle(how);
        H5Pset_deflate(how, 4);
        const hid_t made =
            H5Dcreate2(group, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
        H5Pclose(how);
        H5Sclose(space);
        return made;
    }

    std::string path_;
    hid_t file_ = -1;
};

} // namespace boxwood
