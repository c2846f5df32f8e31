/// A program for tests of `boxwood record`, which knows nothing of Boxwood: every manager in turn,
/// every kind of call, a query within a callback, a manager where another one was, threads. Prints
/// what came out. With "other" it calls no manager, and ends with 3.

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_interval_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <barrier>
#include <cstdio>
#include <memory>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace {

using Manager = fcl::BroadPhaseCollisionManagerd;
using Object = fcl::CollisionObjectd;
using Objects = std::vector<std::unique_ptr<Object>>;

struct Count {
    const Manager* within = nullptr; ///< queried again for each pair
    std::size_t shown = 0, inner = 0;

    static bool add(Object* a, Object*, void* to) {
        Count& self = *static_cast<Count*>(to);
        ++self.shown;
        if (self.within) {
            Count inner;
            self.within->collide(a, &inner, add);
            self.inner += inner.shown;
        }
        return false;
    }
    static bool touch(Object* a, Object* b, void* to) {
        Count& self = *static_cast<Count*>(to);
        ++self.shown;
        fcl::CollisionResultd result;
        self.inner += fcl::collide(a, b, fcl::CollisionRequestd(4, true), result);
        return false;
    }
    static bool measure(Object* a, Object* b, void* to, double& least) {
        ++static_cast<Count*>(to)->shown;
        fcl::DistanceResultd result;
        fcl::distance(a, b, fcl::DistanceRequestd(), result);
        least = std::min(least, result.min_distance);
        return false;
    }
};

Objects made(double from) {
    const auto box = std::make_shared<fcl::Boxd>(1, 1, 1);
    const auto ball = std::make_shared<fcl::Sphered>(.6);
    Objects objects;
    for (int i = 0; i < 20; ++i) {
        objects.push_back(i % 2 ? std::make_unique<Object>(box) : std::make_unique<Object>(ball));
        objects.back()->setTranslation({from + .9 * i, .1 * (i % 3), 0});
        objects.back()->computeAABB();
    }
    return objects;
}

void move(Object& object, double by) {
    object.setTranslation(object.getTranslation() + fcl::Vector3d(by, 0, 0));
    object.computeAABB();
}

template <class Kind> void run(const char* name) {
    Objects objects = made(0), others = made(8);
    Kind made_first, made_second;
    Manager &manager = made_first, &other = made_second; // as programs do that choose one
    for (const auto& object : objects)
        manager.registerObject(object.get());
    std::vector<Object*> list;
    for (const auto& object : others)
        list.push_back(object.get());
    other.registerObjects(list);
    manager.setup();
    other.setup();
    move(*objects[3], .25);
    manager.update(objects[3].get());
    move(*objects[4], .25);
    manager.update(std::vector<Object*>{objects[4].get()});
    move(*objects[5], .25);
    manager.update();
    manager.unregisterObject(objects[19].get());
    Count self, one, two, nested, touching, far, near, apart;
    nested.within = &other;
    manager.collide(&self, Count::add);
    manager.collide(others[0].get(), &one, Count::add);
    manager.collide(&other, &two, Count::add);
    manager.collide(others[1].get(), &nested, Count::add);
    manager.collide(&touching, Count::touch);
    if constexpr (!std::is_same_v<Kind,
                                  fcl::SaPCollisionManagerd>) { // whose own read beyond an end
        manager.distance(&far, Count::measure);
        manager.distance(others[0].get(), &near, Count::measure);
        manager.distance(&other, &apart, Count::measure);
    }
    std::printf("%s %zu %zu %zu %zu %zu %zu %zu %zu\n", name, self.shown, one.shown, two.shown,
                nested.shown, nested.inner, touching.shown, touching.inner,
                far.shown + near.shown + apart.shown);
    manager.clear();
}

/// Calls that a compiler knows the target of, of a class that is derived from a manager.
struct Derived : fcl::DynamicAABBTreeCollisionManagerd {};

void run_direct(const char* name) {
    const Objects objects = made(0), others = made(8);
    Derived manager;
    for (std::size_t i = 0; i < 12; ++i) // so that its answers are its own
        manager.registerObject(objects[i].get());
    manager.setup();
    Count self, one;
    manager.collide(&self, Count::add);
    manager.collide(others[0].get(), &one, Count::add);
    std::printf("%s %zu %zu\n", name, self.shown, one.shown);
}

/// Two threads, each within a query of one manager, query the other one at the same time. A
/// recorder that locks its manager while a callback runs never comes back from it.
void run_crossed(const char* name) {
    const Objects objects = made(0), others = made(8);
    fcl::DynamicAABBTreeCollisionManagerd one, two;
    for (const auto& object : objects)
        one.registerObject(object.get());
    for (const auto& object : others)
        two.registerObject(object.get());
    one.setup();
    two.setup();
    std::barrier<> both(2);
    struct Crossing {
        const Manager* other;
        std::barrier<>* both;
        bool has_met = false;
        std::size_t shown = 0, inner = 0;

        static bool show(Object* a, Object*, void* to) {
            Crossing& self = *static_cast<Crossing*>(to);
            if (!std::exchange(self.has_met, true))
                self.both->arrive_and_wait();
            ++self.shown;
            Count inner;
            self.other->collide(a, &inner, Count::add);
            self.inner += inner.shown;
            return false;
        }
    } first{&two, &both}, second{&one, &both};
    std::thread thread([&] { one.collide(&first, Crossing::show); });
    two.collide(&second, Crossing::show);
    thread.join();
    std::printf("%s %zu %zu %zu %zu\n", name, first.shown, first.inner, second.shown, second.inner);
}

} // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "other")
        return 3;
    run<fcl::DynamicAABBTreeCollisionManagerd>("dynamic_tree");
    run<fcl::DynamicAABBTreeCollisionManager_Arrayd>("dynamic_tree_array");
    run<fcl::SaPCollisionManagerd>("sap");
    run<fcl::SSaPCollisionManagerd>("ssap");
    run<fcl::IntervalTreeCollisionManagerd>("interval_tree");
    run<fcl::NaiveCollisionManagerd>("naive");
    run<fcl::DynamicAABBTreeCollisionManagerd>("dynamic_tree_again");
    run_direct("direct");
    run_direct("direct_again");
    run_crossed("crossed");
    std::printf("arguments:");
    for (int i = 1; i < argc; ++i)
        std::printf(" %s", argv[i]);
    std::printf("\n");
    return argc > 1 && std::string_view(argv[1]) == "--fail" ? 7 : 0;
}
