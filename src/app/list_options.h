// Options whose value is a list: the settings that a report tries.
#pragma once
#include "app/options.h"

namespace tessera
{

extern const Custom kRatesOption;    // "16,8,4": AppOptions::rates
extern const Custom kRastersOption;  // "soft,mesh": AppOptions::rasters
extern const Custom kMetricsOption;  // "edge,detail": AppOptions::metrics
extern const Custom kSizesOption;    // "1920x1080,3840x2160": AppOptions::sizes

// What a report tries: what was asked for, or the default.
std::vector<double> ratesOf(const AppOptions& options);
std::vector<Raster> rastersOf(const AppOptions& options);
std::vector<Metric> metricsOf(const AppOptions& options);
std::vector<std::array<uint32_t, 2>> sizesOf(const AppOptions& options);

}  // namespace tessera
