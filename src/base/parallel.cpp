#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace tessera
{

void parallelFor(size_t count, const std::function<void(size_t)>& body)
{
	const size_t thread_count = std::min<size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
	std::atomic<size_t> next = 0;
	const auto work = [&] {
		for (size_t i = next++; i < count; i = next++)
			body(i);
	};
	std::vector<std::jthread> threads;
	for (size_t i = 1; i < thread_count; ++i)
		threads.emplace_back(work);
	work();
}

}  // namespace tessera
