#include "config/toml_table.hpp"
