#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace tessera
{

void parallelFor(size_t count, const std::function<void(size_t)>& body)
{
	const size_t thread_count = std::min<size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
	std::atomic<size_t> next = 0;
	std::atomic<bool> out_of_memory = false;
	const auto work = [&] {
		try
		{
			for (size_t i = next++; i < count && !out_of_memory; i = next++)
				body(i);
		}
		catch (const std::bad_alloc&)
		{
			out_of_memory = true;
		}
	};
	{
		std::vector<std::jthread> threads;
		threads.reserve(thread_count);
		try
		{
			for (size_t i = 1; i < thread_count; ++i)
				threads.emplace_back(work);
		}
		catch (const std::system_error&)  // no memory for another thread's stack: those there are do it
		{}
		work();
	}
	if (out_of_memory)
		throw std::bad_alloc();
}

}  // namespace tessera
