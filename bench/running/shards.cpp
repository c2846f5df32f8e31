#include "bench/running/shards.h"

#include "bench/io/bad_input.h"
#include "results/schema.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

/// Writes and deletes as much as a shard may take. An error number, 0 if all went well.
int probe(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return errno;
    const std::string block(1 << 20, 'x');
    const ssize_t written = ::write(descriptor, block.data(), block.size());
    int error = written < 0 ? errno : 0;
    if (!error && static_cast<std::size_t>(written) < block.size())
        error = ENOSPC;
    if (::fsync(descriptor) != 0 && !error)
        error = errno;
    ::close(descriptor);
    ::unlink(file.c_str());
    return error;
}

} // namespace

Lock::Lock(fs::path file, const std::string& message) : file_(std::move(file)) {
    for (;;) {
        descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor_ < 0)
            return; // no place to write in at all, which the caller finds out
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            std::array<char, 16> holder{};
            const ssize_t n = ::pread(descriptor_, holder.data(), holder.size(), 0);
            ::close(descriptor_);
            throw BadInput(
                fmt::format("{} (process {})", message,
                            std::string_view(holder.data(),
                                             static_cast<std::size_t>(std::max<ssize_t>(n, 0)))));
        }
        struct stat mine {
        }, there{};
        if (::fstat(descriptor_, &mine) == 0 && ::stat(file_.c_str(), &there) == 0 &&
            mine.st_ino == there.st_ino)
            break;
        ::close(descriptor_); // its last holder has just removed it
    }
    const std::string pid = std::to_string(::getpid());
    if (::ftruncate(descriptor_, 0) == 0)
        (void)!::pwrite(descriptor_, pid.data(), pid.size(), 0);
}

Lock::~Lock() {
    if (descriptor_ < 0)
        return;
    ::unlink(file_.c_str());
    ::close(descriptor_);
}

Shards::Shards(const fs::path& out, std::string sweep_hash, std::string env_hash)
    : all_((fs::exists(out) ? fs::canonical(out) : out).string() + ".shards"),
      folder_(all_ / (sweep_hash + "-" + env_hash)), sweep_hash_(std::move(sweep_hash)),
      env_hash_(std::move(env_hash)) {}

Shards::~Shards() {
    if (!lock_)
        return;
    std::error_code error;
    fs::remove(folder_, error); // only if empty, as all_
    lock_.reset();
    fs::remove(all_, error);
}

void Shards::open() {
    const fs::path parent = all_.has_parent_path() ? all_.parent_path() : ".";
    std::error_code error;
    if (!fs::is_directory(parent, error))
        throw BadInput(fmt::format("--out: there is no folder {}; make it: mkdir -p {}",
                                   parent.string(), parent.string()));
    fs::create_directories(all_, error);
    if (!lock_)
        lock_.emplace(all_ / "lock",
                      fmt::format("--out: another sweep writes {}: wait for it, or choose another "
                                  "--out",
                                  fs::path(all_).replace_extension().string()));
    fs::create_directories(folder_, error);
    const int cause = error ? error.value() : probe(folder_ / "probe");
    if (cause == 0)
        return;
    throw BadInput(fmt::format("--out: cannot write in {}: {}; {}", parent.string(),
                               std::strerror(cause),
                               cause == ENOSPC ? "free some space or choose another place"
                                               : "choose another place for the results"));
}

fs::path Shards::round_file(unsigned round) const {
    return folder_ / fmt::format("round-{:04}.h5", round);
}

std::map<unsigned, results::Results> Shards::rounds() const {
    std::map<unsigned, results::Results> found;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("round-") || !name.ends_with(".h5"))
            continue;
        if (std::optional<results::Results> results = read(entry.path()))
            for (const unsigned round : rounds_in(*results))
                found.insert_or_assign(round, std::move(*results));
    }
    return found;
}

bool Shards::belongs(const results::Results& results) const {
    return results.sweep_hash == sweep_hash_ &&
           std::ranges::any_of(results.env,
                               [&](const results::Env& env) { return env.env_hash == env_hash_; });
}

void Shards::remove() {
    std::error_code error;
    fs::remove_all(folder_, error);
    lock_.reset();
    fs::remove(all_, error); // only if empty
}

/// A shard is renamed into place when it is complete, so one that cannot be read is damaged: it
/// counts as not there and is made again.
std::optional<results::Results> Shards::read(const fs::path& file) const {
    if (!fs::exists(file))
        return std::nullopt;
    try {
        results::Results results = results::read(file);
        if (belongs(results))
            return results;
    } catch (const std::runtime_error&) {
    }
    return std::nullopt;
}

std::set<unsigned> rounds_in(const results::Results& results) {
    std::set<unsigned> rounds;
    for (const results::Shard& shard : results.shards)
        rounds.insert(shard.round);
    return rounds;
}

results::Results without_rounds(results::Results results) {
    results.shards.clear();
    results.samples.clear();
    results.frames.clear();
    results.effects.clear();
    for (const results::Table& table : results::tables())
        if (table.is_derived)
            table.resize(results, 0);
    return results;
}

} // namespace boxwood::bench
