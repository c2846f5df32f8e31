#include "bench/peers/answering.h"
#include "bench/peers/mesh_peers.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <memory>
#include <vector>

namespace boxwood::bench {
namespace on_meshes {
namespace {

/// Whether there was a contact.
struct Touched final : btManifoldResult {
    Touched(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b)
        : btManifoldResult(a, b) {}
    void addContactPoint(const btVector3&, const btVector3&, btScalar) override { yes = true; }
    bool yes = false;
};

/// A mesh in arrays that Bullet reads where they are, and its shape. No margin: that would make the
/// triangles thick.
class GimpactMesh {
  public:
    explicit GimpactMesh(const TriangleMesh& mesh) {
        for (const Vec3<float>& v : mesh.vertices)
            corners_.insert(corners_.end(), {v.x, v.y, v.z});
        for (const auto& [a, b, c] : mesh.triangles)
            for (const std::uint32_t vertex : {a, b, c})
                indices_.push_back(static_cast<int>(vertex));
        arrays_ = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(indices_.size() / 3), indices_.data(),
            static_cast<int>(3 * sizeof(int)), static_cast<int>(corners_.size() / 3),
            corners_.data(), static_cast<int>(3 * sizeof(btScalar)));
    }
    void build() {
        shape_.reset();
        shape_ = std::make_unique<btGImpactMeshShape>(arrays_.get());
        shape_->setMargin(0);
        shape_->updateBound();
    }
    btGImpactMeshShape& shape() { return *shape_; }

  private:
    std::vector<btScalar> corners_;
    std::vector<int> indices_;
    std::unique_ptr<btTriangleIndexVertexArray> arrays_;
    std::unique_ptr<btGImpactMeshShape> shape_;
};

btTransform transform_of(const RigidTransform<double>& pose) {
    const auto number = [&](std::size_t row, int column) {
        return static_cast<btScalar>(pose.rotation[row][column]);
    };
    return btTransform(btMatrix3x3(number(0, 0), number(0, 1), number(0, 2), number(1, 0),
                                   number(1, 1), number(1, 2), number(2, 0), number(2, 1),
                                   number(2, 2)),
                       btVector3(static_cast<btScalar>(pose.translation.x),
                                 static_cast<btScalar>(pose.translation.y),
                                 static_cast<btScalar>(pose.translation.z)));
}

class Touches final : public Contender {
  public:
    explicit Touches(const Job& job) : mesh_(job.scene->mesh), dispatcher_(&configuration_) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
        if (job.scene->has_other_copy())
            other_ = std::make_unique<GimpactMesh>(job.scene->copy());
        for (const RigidTransform<double>& pose : job.scene->poses)
            poses_.push_back(transform_of(pose));
    }
    void build() override {
        mesh_.build();
        if (other_)
            other_->build();
        object_.setCollisionShape(&mesh_.shape());
        copy_.setCollisionShape(other_ ? &other_->shape() : &mesh_.shape());
    }
    void query(Answers& answers) override {
        list_of<std::uint8_t>(answers).clear();
        for (std::size_t i = 0; i < poses_.size(); ++i)
            query_part(answers, i);
    }
    void query_part(Answers& answers, std::size_t part) override {
        copy_.setWorldTransform(poses_[part]);
        const btCollisionObjectWrapper a(nullptr, object_.getCollisionShape(), &object_,
                                         object_.getWorldTransform(), -1, -1);
        const btCollisionObjectWrapper b(nullptr, copy_.getCollisionShape(), &copy_,
                                         copy_.getWorldTransform(), -1, -1);
        btCollisionAlgorithm* const algorithm =
            dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
        Touched touched(&a, &b);
        algorithm->processCollision(&a, &b, btDispatcherInfo(), &touched);
        algorithm->~btCollisionAlgorithm();
        dispatcher_.freeCollisionAlgorithm(algorithm);
        list_of<std::uint8_t>(answers).push_back(touched.yes);
    }

  private:
    GimpactMesh mesh_;
    std::unique_ptr<GimpactMesh> other_; ///< of a copy of its own
    std::vector<btTransform> poses_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btCollisionObject object_, copy_;
};

} // namespace
} // namespace on_meshes

std::vector<ContenderEntry> bullet_meshes() {
    ContenderEntry e;
    e.name = "bullet.gimpact_mesh";
    e.library = "bullet";
    e.summary = "Bullet's btGImpactMeshShape, two objects and btGImpactCollisionAlgorithm";
    e.notes =
        "build = the shape and its quantised tree of boxes, which stands for the mesh and for "
        "its copy (two where that is larger), no margin; query = findAlgorithm and "
        "processCollision as contactPairTest does, pose after pose: all contacts are found, it "
        "has no early exit; floats, to which poses are rounded; one thread";
    e.precision = "f32";
    e.runs_on = RunsOn::one_thread;
    e.answers = {answering<on_meshes::Touches>("collide")};
    return {e};
}

} // namespace boxwood::bench
