/// Loaded by `boxwood record` before the libraries of a program: has the symbols of FCL's managers
/// in libfcl, so that their calls come here, and go on to FCL by way of a recorder; and those of
/// the functions by which callbacks query shapes. Each process claims files of its own,
/// BOXWOOD_RECORD and then the same with -2, -3 ...

#include "bench/recording/recording_names.h"
#include "trees/adapters/fcl_recorder.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#define BOXWOOD_COLLIDE                                                                            \
    "_ZN3fcl7collideIdEEmPKNS_15CollisionObjectIT_EES5_"                                           \
    "RKNS_16CollisionRequestIS2_EERNS_15CollisionResultIS2_EE"
#define BOXWOOD_DISTANCE                                                                           \
    "_ZN3fcl8distanceIdEET_PKNS_15CollisionObjectIS1_EES5_"                                        \
    "RKNS_15DistanceRequestIS1_EERNS_14DistanceResultIS1_EE"

namespace {

using Manager = fcl::BroadPhaseCollisionManager<double>;
using Object = fcl::CollisionObject<double>;
using Objects = std::vector<Object*>;
using CollideCallback = fcl::CollisionCallBack<double>;
using DistanceCallback = fcl::DistanceCallBack<double>;
using Recorder = boxwood::FclRecorder<double>;

/// Whether this thread is within a call that is being recorded: what FCL and the recorder then ask
/// of managers is no call of the program.
thread_local bool is_within = false;

class Within {
  public:
    explicit Within(bool is) : before_(is_within) { is_within = is; }
    ~Within() { is_within = before_; }
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

  private:
    bool before_;
};

/// The recorders of a process. Never destroyed, as programs call their managers until the very end.
class Recorders {
  public:
    static Recorders& all() {
        static auto* const recorders = new Recorders;
        return *recorders;
    }

    /// Null if this manager is not recorded.
    Recorder* of(Manager* manager) {
        if (is_child_) // before a lock that another thread of the parent may have held
            return nullptr;
        const std::lock_guard lock(mutex_);
        const auto [found, is_new] = by_manager_.try_emplace(manager);
        if (is_new && !is_over_)
            found->second = begin(*manager);
        return found->second.get();
    }
    /// A manager has been made, maybe where another one was.
    void made(Manager* manager) {
        Recorder* recorder = nullptr;
        if (is_child_)
            return;
        {
            const std::lock_guard lock(mutex_);
            if (const auto found = by_manager_.find(manager); found != by_manager_.end())
                recorder = found->second.get();
        }
        if (recorder)
            recorder->clear();
    }

  private:
    Recorders() {
        pthread_atfork(nullptr, nullptr,
                       [] { all().is_child_ = true; }); // the files are the parent's
    }

    std::unique_ptr<Recorder> begin(Manager& manager) {
        if (const auto file = claimed()) {
            try {
                // HDF5 itself would crash at the exit if the disk is full; end() does what it does.
                if (!std::exchange(has_end_, true)) {
                    ends_hdf5_ = H5dont_atexit() >= 0;
                    std::atexit([] { all().end(); });
                }
                auto recorder = std::make_unique<Recorder>(manager, *file);
                recorder->on_failure([](const std::exception& error) { all().fail(error); });
                return recorder;
            } catch (const std::exception& error) {
                fail(error);
            }
        }
        return nullptr;
    }
    void fail(const std::exception& error) {
        has_failed_ = true;
        std::fprintf(stderr, "boxwood record: %s\n", error.what());
    }
    static std::optional<std::filesystem::path> claimed() {
        const char* const first = std::getenv(boxwood::recording::file_variable);
        if (!first)
            return std::nullopt;
        for (unsigned i = 1; i <= boxwood::recording::most_files; ++i) {
            const std::filesystem::path file = boxwood::recording::numbered(first, i);
            const int claim = open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
            if (claim >= 0) {
                close(claim);
                return file;
            }
        }
        return std::nullopt;
    }
    void end() {
        if (is_child_)
            return;
        const std::lock_guard lock(mutex_);
        if (std::exchange(is_over_, true))
            return;
        for (auto& [manager, recorder] : by_manager_)
            try {
                if (recorder)
                    recorder->close();
            } catch (const std::exception& error) {
                fail(error);
            }
        if (ends_hdf5_ && !has_failed_)
            H5close();
    }

    std::mutex mutex_;
    std::map<Manager*, std::unique_ptr<Recorder>> by_manager_;
    bool has_end_ = false, is_over_ = false;
    bool ends_hdf5_ = false;
    std::atomic<bool> is_child_ = false, has_failed_ = false;
};

template <class Callback> class Shown {
  public:
    Shown(void* data, Callback callback) : data_(data), callback_(callback) {}

    /// query(data, callback) of a query that hands on what it is shown.
    template <class Query> void hand(const Query& query) { query(this, Callback(show)); }

  private:
    /// What a callback asks of managers is a call of the program again.
    template <class... More> static bool show(Object* a, Object* b, void* to, More&... more) {
        const Within program(false);
        const auto& self = *static_cast<Shown*>(to);
        return self.callback_(a, b, self.data_, more...);
    }

    void* data_;
    Callback callback_;
};
using ShownCollision = Shown<CollideCallback>;
using ShownDistance = Shown<DistanceCallback>;

/// The function of FCL of that name.
template <class Function> Function* in_fcl(const char* symbol) {
    if (void* const found = dlsym(RTLD_NEXT, symbol))
        return reinterpret_cast<Function*>(found);
    std::fprintf(stderr, "boxwood record: this program's FCL has no %s\n", symbol);
    std::abort();
}

/// record(recorder), or go_on() where the call is not one of the program to a recorded manager.
template <class GoOn, class Record>
void take(Manager* manager, const GoOn& go_on, const Record& record) {
    if (is_within)
        return go_on();
    const Within call(true);
    if (Recorder* const recorder = Recorders::all().of(manager))
        record(*recorder);
    else
        go_on();
}

/// answer() about the shapes of a pair, written down if a callback of a recorded call makes the
/// query.
template <class Request, class Query> auto timed(const Request& request, const Query& answer) {
    if (is_within)
        return answer();
    return Recorder::timed(request, [&] {
        const Within query(true); // FCL calls itself
        return answer();
    });
}

} // namespace

extern "C" [[gnu::visibility("default")]] std::size_t
boxwood_record_collide(const Object* a, const Object* b, const fcl::CollisionRequestd& request,
                       fcl::CollisionResultd& result) asm(BOXWOOD_COLLIDE);
std::size_t boxwood_record_collide(const Object* a, const Object* b,
                                   const fcl::CollisionRequestd& request,
                                   fcl::CollisionResultd& result) {
    static const auto next = in_fcl<decltype(boxwood_record_collide)>(BOXWOOD_COLLIDE);
    return timed(request, [&] { return next(a, b, request, result); });
}
extern "C" [[gnu::visibility("default")]] double
boxwood_record_distance(const Object* a, const Object* b, const fcl::DistanceRequestd& request,
                        fcl::DistanceResultd& result) asm(BOXWOOD_DISTANCE);
double boxwood_record_distance(const Object* a, const Object* b,
                               const fcl::DistanceRequestd& request, fcl::DistanceResultd& result) {
    static const auto next = in_fcl<decltype(boxwood_record_distance)>(BOXWOOD_DISTANCE);
    return timed(request, [&] { return next(a, b, request, result); });
}

// A member function is called as a function with the object as its first argument. NAME is of the
// function here, SYMBOL that of the member.
#define BOXWOOD_TAKE(NAME, SYMBOL, PARAMETERS, ARGUMENTS, RECORD)                                  \
    extern "C" [[gnu::visibility("default")]] void NAME PARAMETERS asm(SYMBOL);                    \
    void NAME PARAMETERS {                                                                         \
        static const auto next = in_fcl<void PARAMETERS>(SYMBOL);                                  \
        take(                                                                                      \
            self, [&] { next ARGUMENTS; }, [&](Recorder& to) { RECORD; });                         \
    }

#define BOXWOOD_OBJECT "PNS_15CollisionObjectIdEE"
#define BOXWOOD_OBJECTS "RKSt6vectorIPNS_15CollisionObjectIdEESaIS5_EE"
#define BOXWOOD_OTHERS "PNS_26BroadPhaseCollisionManagerIdEE"
#define BOXWOOD_CALLBACK(OBJECT, SECOND, DATA, MORE) "PvPFb" OBJECT SECOND DATA MORE "E"

#define BOXWOOD_MADE(NAME, SYMBOL)                                                                 \
    extern "C" [[gnu::visibility("default")]] void NAME(Manager* self) asm(SYMBOL);                \
    void NAME(Manager* self) {                                                                     \
        static const auto next = in_fcl<void(Manager*)>(SYMBOL);                                   \
        const bool is_call = !is_within;                                                           \
        const Within call(true);                                                                   \
        next(self);                                                                                \
        if (is_call)                                                                               \
            Recorders::all().made(self);                                                           \
    }

#define BOXWOOD_MANAGER(ID, CLASS)                                                                 \
    BOXWOOD_MADE(ID##_made, "_ZN3fcl" CLASS "IdEC1Ev")                                             \
    BOXWOOD_MADE(ID##_made_base, "_ZN3fcl" CLASS "IdEC2Ev") /* of a class derived from it */       \
    BOXWOOD_TAKE(ID##_add, "_ZN3fcl" CLASS "IdE14registerObjectE" BOXWOOD_OBJECT,                  \
                 (Manager * self, Object * object), (self, object), to.registerObject(object))     \
    BOXWOOD_TAKE(ID##_add_all, "_ZN3fcl" CLASS "IdE15registerObjectsE" BOXWOOD_OBJECTS,            \
                 (Manager * self, const Objects& objects), (self, objects),                        \
                 to.registerObjects(objects))                                                      \
    BOXWOOD_TAKE(ID##_remove, "_ZN3fcl" CLASS "IdE16unregisterObjectE" BOXWOOD_OBJECT,             \
                 (Manager * self, Object * object), (self, object), to.unregisterObject(object))   \
    BOXWOOD_TAKE(ID##_clear, "_ZN3fcl" CLASS "IdE5clearEv", (Manager * self), (self), to.clear())  \
    BOXWOOD_TAKE(ID##_setup, "_ZN3fcl" CLASS "IdE5setupEv", (Manager * self), (self), to.setup())  \
    BOXWOOD_TAKE(ID##_update, "_ZN3fcl" CLASS "IdE6updateEv", (Manager * self), (self),            \
                 to.update())                                                                      \
    BOXWOOD_TAKE(ID##_update_one, "_ZN3fcl" CLASS "IdE6updateE" BOXWOOD_OBJECT,                    \
                 (Manager * self, Object * object), (self, object), to.update(object))             \
    BOXWOOD_TAKE(ID##_update_some, "_ZN3fcl" CLASS "IdE6updateE" BOXWOOD_OBJECTS,                  \
                 (Manager * self, const Objects& objects), (self, objects), to.update(objects))    \
    BOXWOOD_QUERIES(ID, CLASS, collide, "7collide", CollideCallback, ShownCollision, "")           \
    BOXWOOD_QUERIES(ID, CLASS, distance, "8distance", DistanceCallback, ShownDistance, "Rd")

#define BOXWOOD_QUERIES(ID, CLASS, METHOD, NAME, CALLBACK, SHOWN, MORE)                            \
    BOXWOOD_TAKE(                                                                                  \
        ID##_##METHOD##_object,                                                                    \
        "_ZNK3fcl" CLASS "IdE" NAME                                                                \
        "E" BOXWOOD_OBJECT BOXWOOD_CALLBACK("S4_", "S4_", "S5_", MORE),                            \
        (Manager * self, Object * object, void* data, CALLBACK callback),                          \
        (self, object, data, callback),                                                            \
        (SHOWN{data, callback}.hand([&](void* d, CALLBACK c) { to.METHOD(object, d, c); })))       \
    BOXWOOD_TAKE(                                                                                  \
        ID##_##METHOD##_others,                                                                    \
        "_ZNK3fcl" CLASS "IdE" NAME                                                                \
        "E" BOXWOOD_OTHERS BOXWOOD_CALLBACK(BOXWOOD_OBJECT, "S8_", "S5_", MORE),                   \
        (Manager * self, Manager * others, void* data, CALLBACK callback),                         \
        (self, others, data, callback),                                                            \
        (SHOWN{data, callback}.hand([&](void* d, CALLBACK c) { to.METHOD(others, d, c); })))       \
    BOXWOOD_TAKE(ID##_##METHOD##_self,                                                             \
                 "_ZNK3fcl" CLASS "IdE" NAME                                                       \
                 "E" BOXWOOD_CALLBACK(BOXWOOD_OBJECT, "S5_", "S2_", MORE),                         \
                 (Manager * self, void* data, CALLBACK callback), (self, data, callback),          \
                 (SHOWN{data, callback}.hand([&](void* d, CALLBACK c) { to.METHOD(d, c); })))

BOXWOOD_MANAGER(dynamic_tree, "31DynamicAABBTreeCollisionManager")
BOXWOOD_MANAGER(dynamic_tree_array, "37DynamicAABBTreeCollisionManager_Array")
BOXWOOD_MANAGER(sap, "19SaPCollisionManager")
BOXWOOD_MANAGER(ssap, "20SSaPCollisionManager")
BOXWOOD_MANAGER(interval_tree, "28IntervalTreeCollisionManager")
BOXWOOD_MANAGER(naive, "21NaiveCollisionManager")
