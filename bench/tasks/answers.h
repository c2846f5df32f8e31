#pragma once

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace boxwood::bench {

/// What a contender answers into. Each task makes its own kind (`Task::make_answers`); the caller
/// reserves it before timing and hands the same one to every query.
class Answers {
  public:
    virtual ~Answers() = default;
    virtual std::size_t size() const = 0;
    virtual void reserve(std::size_t n) = 0;
    // To another process, which judges them. Throw std::logic_error where answers cannot travel.
    virtual std::string bytes() const { throw std::logic_error("answers without bytes"); }
    virtual void assign_bytes(std::string_view /*bytes*/) {
        throw std::logic_error("answers without bytes");
    }
};

/// Answers that are a list: pairs, hits, distances ...
template <class T> struct AnswerList : Answers {
    std::vector<T> list;

    std::size_t size() const override { return list.size(); }
    void reserve(std::size_t n) override { list.reserve(n); }
    std::string bytes() const override {
        return {reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T)};
    }
    void assign_bytes(std::string_view bytes) override {
        static_assert(std::is_trivially_copyable_v<T>);
        list.resize(bytes.size() / sizeof(T));
        if (!list.empty())
            std::memcpy(list.data(), bytes.data(), list.size() * sizeof(T));
    }
};

/// The list of a task's answers. Throws std::bad_cast if they are of another kind.
template <class T> std::vector<T>& list_of(Answers& answers) {
    return dynamic_cast<AnswerList<T>&>(answers).list;
}
template <class T> const std::vector<T>& list_of(const Answers& answers) {
    return dynamic_cast<const AnswerList<T>&>(answers).list;
}

} // namespace boxwood::bench
