/// Result files. A first byte of 0: the bytes are the file. Odd: they are changes (place, byte) of
/// a good one. Else they are changes (table, row, column, value) of the rows before it is written
/// and sealed. Refused, or read as it is.

#include "bench/fuzz/scratch_file.h"
#include "results/testing/example.h"

#include <iterator>

namespace boxwood::fuzz {
namespace {

/// Some tables' ids and texts made anything.
results::Results changed(Reader in) {
    results::Results results = results::filled_example(1);
    while (!in.at_end()) {
        const std::size_t wanted = in.take<std::uint8_t>(), column = in.take<std::uint8_t>();
        const auto number = in.take<std::uint32_t>();
        if (wanted >= results::tables().size())
            continue;
        const results::Table& table = results::tables()[wanted];
        const results::Column& at = table.columns[column % table.columns.size()];
        std::byte* row = table.rows(results)[0];
        if (at.stored == results::Stored::uint32)
            at.value<std::uint32_t>(row) = number;
        else if (at.stored == results::Stored::uint64)
            at.value<std::uint64_t>(row) = number;
        else if (at.stored == results::Stored::real)
            at.value<double>(row) = number;
        else
            at.set_text(row, std::string(number % 5, static_cast<char>(number >> 8)));
    }
    return results;
}

std::string good_file(const std::filesystem::path& path) {
    results::write(path, results::filled_example(1));
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

void result_file(Bytes bytes) {
    static const ScratchFile file(".h5");
    Reader in(bytes);
    const auto mode = in.take<std::uint8_t>();
    try {
        if (mode == 0) {
            file.holding(bytes.subspan(bytes.empty() ? 0 : 1));
        } else if (mode % 2 == 1) {
            static const std::string good = good_file(file.path());
            std::string bad = good;
            while (!in.at_end()) {
                const std::size_t place = in.take<std::uint32_t>() % bad.size();
                bad[place] = static_cast<char>(in.take<std::uint8_t>());
            }
            file.holding({reinterpret_cast<const std::uint8_t*>(bad.data()), bad.size()});
        } else {
            const results::Results results = changed(in);
            results::write(file.path(), results);
            require(results::difference(results, results::read(file.path())).empty(),
                    "what was written is not what is read");
        }
        results::read(file.path());
    } catch (const std::runtime_error& error) {
        require(std::string_view(error.what()).find(file.path().string()) != std::string_view::npos,
                std::string("an error without the file's name: ") + error.what());
    }
}

} // namespace boxwood::fuzz
