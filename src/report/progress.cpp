#include "report/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace tessera::report
{

namespace
{

constexpr auto kInterval = std::chrono::milliseconds(100);
constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(bool shown) : shown_(shown && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress()
{
	end();
}

void Progress::begin(const std::string& what, uint64_t total)
{
	what_ = what;
	total_ = std::max<uint64_t>(total, 1);
	done_ = 0;
	drawn_ = {};
	if (shown_)
		draw();
}

void Progress::advance(uint64_t steps)
{
	done_ += steps;
	if (!shown_)
		return;
	const std::unique_lock lock(drawing_, std::try_to_lock);
	if (lock.owns_lock() && std::chrono::steady_clock::now() - drawn_ >= kInterval)
		draw();
}

void Progress::end()
{
	if (shown_)
		fmt::print(stderr, "\r\x1b[K");
}

void Progress::draw()
{
	drawn_ = std::chrono::steady_clock::now();
	const double share = std::min(1.0, double(done_.load()) / double(total_));
	const int full = static_cast<int>(share * kBarWidth);
	fmt::print(stderr, "\r\x1b[K{:<44} [{:#<{}}{:<{}}] {:3.0f} %", what_, "", full, "", kBarWidth - full, share * 100);
	std::fflush(stderr);
}

}  // namespace tessera::report
