// Work spread over the processor's threads.
#pragma once
#include <cstddef>
#include <functional>

namespace tessera
{

// Calls body(i) once for every i in [0, count), on all hardware threads, and returns when all are done.
// The order is free. body must throw nothing but std::bad_alloc, which then comes from here, with some calls left out.
void parallelFor(size_t count, const std::function<void(size_t)>& body);

}  // namespace tessera
