#pragma once

#include "trees/adapters/detail/call_recorder.h"

#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

namespace boxwood::detail {

/// What recorders have in common, whatever their library's callbacks are: all but the queries.
template <class Library> class RecordedManager : public Library::Manager {
  public:
    using Object = typename Library::Object;
    using Objects = std::vector<Object*>;
    using Manager = typename Library::Manager;

    RecordedManager(Manager& manager, const std::filesystem::path& file) : calls_(manager, file) {}

    /// The end of the recording; calls are handed on, and not written down any more.
    void close() { calls_.close(); }
    /// A recording that cannot be written any more ends there, and this is told instead of thrown.
    void on_failure(std::function<void(const std::exception&)> tell) {
        calls_.on_failure(std::move(tell));
    }

    void registerObject(Object* object) override {
        calls_.record(recording::Call::add, {object}, [&] { to().registerObject(object); });
    }
    void registerObjects(const Objects& objects) override {
        calls_.record(recording::Call::add, objects, [&] { to().registerObjects(objects); });
    }
    void unregisterObject(Object* object) override {
        calls_.record(recording::Call::remove, {object}, [&] { to().unregisterObject(object); });
    }
    void clear() override {
        calls_.record(recording::Call::clear, {}, [&] { to().clear(); });
    }
    void setup() override {
        calls_.record(recording::Call::setup, {}, [&] { to().setup(); });
    }
    void update() override {
        calls_.record(recording::Call::update_all, Library::objects_of(to()),
                      [&] { to().update(); });
    }
    void update(Object* object) override {
        calls_.record(recording::Call::update_some, {object}, [&] { to().update(object); });
    }
    void update(const Objects& objects) override {
        calls_.record(recording::Call::update_some, objects, [&] { to().update(objects); });
    }
    void getObjects(Objects& objects) const override { to().getObjects(objects); }
    bool empty() const override { return to().empty(); }
    std::size_t size() const override { return to().size(); }

  protected:
    using Calls = CallRecorder<Library>;

    /// Another manager, or the one that another recorder is before.
    static Manager& behind(Manager* other) {
        const auto* const recorder = dynamic_cast<const RecordedManager*>(other);
        return recorder ? recorder->to() : *other;
    }
    Manager& to() const { return calls_.manager(); }

    mutable Calls calls_;
};

} // namespace boxwood::detail
