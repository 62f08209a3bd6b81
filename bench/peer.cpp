#include "bench/peer.h"

#include "app/option_text.h"

#include <algorithm>
#include <cmath>

namespace tessera::bench
{

namespace
{

constexpr std::string_view kColumns[] = { "device", "scene", "width", "height", "px", "gpu_ms", "micro_mtri", "overflow" };

Result<double> positiveAt(const CsvTable& csv, size_t row, std::string_view column, std::string_view path)
{
	const std::optional<double> number = readNumber(csv.at(row, column));
	if (!number || *number <= 0)
		return badInput("{}: row {}, {}: '{}' is not a number above 0", path, row + 1, column, csv.at(row, column));
	return *number;
}

Result<uint32_t> extentAt(const CsvTable& csv, size_t row, std::string_view column, std::string_view path)
{
	const std::optional<uint32_t> extent = readCount(csv.at(row, column), 1, 65536);
	if (!extent)
		return badInput("{}: row {}, {}: '{}' is not a whole number from 1 to 65536", path, row + 1, column, csv.at(row, column));
	return *extent;
}

Result<PeerTime> peerTime(const CsvTable& csv, size_t row, std::string_view path)
{
	PeerTime time;
	time.scene = csv.at(row, "scene");
	TRY_ASSIGN(time.width_px, extentAt(csv, row, "width", path));
	TRY_ASSIGN(time.height_px, extentAt(csv, row, "height", path));
	TRY_ASSIGN(time.px, positiveAt(csv, row, "px", path));
	TRY_ASSIGN(time.gpu_ms, positiveAt(csv, row, "gpu_ms", path));
	if (!csv.at(row, "micro_mtri").empty())
	{
		TRY_ASSIGN(time.micro_mtri, positiveAt(csv, row, "micro_mtri", path));
	}
	const std::string_view overflow = csv.at(row, "overflow");
	if (overflow != "yes" && overflow != "no")
		return badInput("{}: row {}, overflow: '{}'; yes or no is right", path, row + 1, overflow);
	time.overflow = overflow == "yes";
	return time;
}

}  // namespace

const PeerTime* PeerTable::find(std::string_view scene, uint32_t width_px, uint32_t height_px, double px) const
{
	const auto found = std::find_if(times.begin(), times.end(), [&](const PeerTime& time) {
		return time.scene == scene && time.width_px == width_px && time.height_px == height_px && time.px == px;
	});
	return found == times.end() ? nullptr : &*found;
}

Result<PeerTable> peerTable(const CsvTable& csv, std::string_view path)
{
	for (std::string_view column : kColumns)
		if (!csv.find(column))
			return badInput("{}: there is no column {}; {} are right", path, column, joinNames(kColumns));
	PeerTable table;
	for (size_t row = 0; row < csv.rows.size(); ++row)
	{
		TRY_ASSIGN(PeerTime time, peerTime(csv, row, path));
		table.times.push_back(std::move(time));
		table.device = csv.at(row, "device");
	}
	return table;
}

std::optional<double> peerPixels(double rate)
{
	constexpr double kOursPerPeers = 0.8660254037844386;  // cos 30 degrees: half the field of view
	for (const double px : { 8.0, 4.0, 2.0, 1.0, 0.5 })
		if (std::abs(rate / (kOursPerPeers * px) - 1) < 0.005)
			return px;
	return std::nullopt;
}

}  // namespace tessera::bench
