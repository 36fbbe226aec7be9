% Reads the levels of a sweep, in MATLAB or Octave: octave-cli problems/read_results.m out/first-mode
folder = 'out/first-mode';
if exist('argv') && numel(argv()) > 0, arguments = argv(); folder = arguments{end}; end
lines = strsplit(strtrim(fileread([folder '/levels.csv'])), char(10));
fields = cellfun(@(line) regexp([line ','], '("[^"]*"|[^,]*),', 'tokens'), lines, 'UniformOutput', false);
rows = cellfun(@(row) [row{:}], fields, 'UniformOutput', false);
column = @(name) cellfun(@(row) row{strcmp(rows{1}, name)}, rows(2:end), 'UniformOutput', false);
solved = strcmp(column('verdict'), 'admissible') & ~strcmp(column('level'), '');
values = cellfun(@(name) str2double(column(name)), {'frequency_hz', 'energy_joule', 'peak_force_n'}, 'UniformOutput', false);
[frequency, energy, force] = deal(values{1}(solved), values{2}(solved), values{3}(solved));
[largest, hard] = max(force);
fprintf('orbits at a level: %d, %.6g to %.6g Hz\n', numel(force), min(frequency), max(frequency));
fprintf('largest force %.6g N at %.6g J, %.6g Hz\n', largest, energy(hard), frequency(hard));
