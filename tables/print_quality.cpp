// Prints the quality table of the built-in table, or of a table file: tessera_table_quality [--all] [TABLE.json]
#include "tables/table_quality.h"

#include <cstdio>
#include <string_view>

int main(int argument_count, char** arguments)
{
	using namespace tessera;
	bool every_config = false;
	Result<TessellationTable> table = defaultTable();
	for (int i = 1; i < argument_count && table; i++)
	{
		if (std::string_view(arguments[i]) == "--all")
			every_config = true;
		else
			table = loadTable(arguments[i]);
	}
	if (!table)
	{
		fmt::print(stderr, "error: {}\n", table.error().message);
		return int(table.error().code);
	}
	fmt::print("{}", qualityReport(measureTable(*table), every_config));
	return 0;
}
