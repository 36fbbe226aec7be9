#pragma once

/// A small sweep: contact, free and trivial patterns, levels below, inside and above.
inline constexpr const char* sweep_scene_text = R"(title = "A sample"
[bar]
length = 2.0
young_modulus = 3.0
density = 1.0
area = 1.0
gap = 0.1
[mesh]
cells = 6
[patterns]
list = [[16, 4], [23, 1], [3, 3], [5, 1]]
[levels]
list = [0.5, 1.6, 12.0]
[program]
objective = "nearest"
)";
