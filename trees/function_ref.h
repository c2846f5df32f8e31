#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace boxwood {

/// A non-owning reference to a callable; the callable must outlive the call it is passed to.
template <class Signature> class FunctionRef;

template <class R, class... Args> class FunctionRef<R(Args...)> {
  public:
    template <class F>
    requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> &&
             std::is_invocable_r_v<R, F&, Args...>)
        FunctionRef(F&& f) // NOLINT: implicit by design, like std::function
        : object_(address_of(f)), call_([](void* object, Args... args) -> R {
              using Callable = std::remove_reference_t<F>;
              return (*reinterpret_cast<Callable*>(object))(std::forward<Args>(args)...);
          }) {}

    R operator()(Args... args) const { return call_(object_, std::forward<Args>(args)...); }

  private:
    template <class F> static void* address_of(F& f) {
        if constexpr (std::is_function_v<F>) // which every system we know keeps as it keeps data
            return reinterpret_cast<void*>(&f);
        else
            return const_cast<void*>(static_cast<const void*>(std::addressof(f)));
    }

    void* object_;
    R (*call_)(void*, Args...);
};

} // namespace boxwood
