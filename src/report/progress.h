// A bar on the terminal for work that takes long. Nothing is shown when standard error is no terminal, or output is quiet.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace tessera::report
{

class Progress
{
public:
	explicit Progress(bool shown);
	~Progress();

	// A new piece of work of `total` steps. Not while others call advance.
	void begin(const std::string& what, uint64_t total);
	void advance(uint64_t steps = 1);  // from any thread
	void end();                        // wipes the bar

private:
	void draw();

	bool shown_;
	std::string what_;
	uint64_t total_ = 1;
	std::atomic<uint64_t> done_ = 0;
	std::mutex drawing_;
	std::chrono::steady_clock::time_point drawn_;
};

}  // namespace tessera::report
