# cmake -D work=DIR -P check_includes_test.cmake: check_includes.cmake must pass a clean tree and fail each fault.
cmake_policy(VERSION 3.25)

set(failed 0)

function(fresh_tree)
  file(REMOVE_RECURSE ${work})
  file(WRITE ${work}/include/nsma/wave/bar.hpp "#include <vector>\n#include <Eigen/Core>\n#include <boost/multiprecision/cpp_int.hpp>\n")
  file(WRITE ${work}/include/nsma/orbit/kernel.hpp "#include \"nsma/wave/bar.hpp\"\n")
  # Among them headers that a case below adds.
  foreach(header wave/bar orbit/kernel orbit/orbit report/store)
    file(APPEND ${work}/include/nsma/nsma.hpp "#include \"nsma/${header}.hpp\"\n")
  endforeach()
  file(WRITE ${work}/src/wave/marcher.cpp "// #include \"nsma/orbit/kernel.hpp\"\n#include \"nsma/wave/bar.hpp\"\n")
  file(WRITE ${work}/src/search/ipopt.cpp "#include <IpIpoptApplication.hpp>\n#include <IpTNLP.hpp>\n")
  file(WRITE ${work}/src/search/nlopt.cpp "#include <nlopt.hpp>\n#include \"nsma/orbit/kernel.hpp\"\n")
  file(WRITE ${work}/src/app/main.cpp "#include <CLI/CLI.hpp>\n#include <fmt/core.h>\n#include \"nsma/orbit/kernel.hpp\"\n")
endfunction()

function(expect outcome name)
  execute_process(COMMAND ${CMAKE_COMMAND} -D tree=${work} -P ${CMAKE_CURRENT_LIST_DIR}/check_includes.cmake
                  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(outcome STREQUAL "pass" AND NOT result EQUAL 0)
    message("${name}: should pass, but:\n${output}")
    math(EXPR failed "${failed} + 1")
  elseif(outcome STREQUAL "fail" AND (result EQUAL 0 OR NOT output MATCHES "1 forbidden includes"))
    message("${name}: should show one fault, but:\n${output}")
    math(EXPR failed "${failed} + 1")
  endif()
  set(failed ${failed} PARENT_SCOPE)
endfunction()

# One file added to the clean tree is one fault.
function(expect_fault file text)
  fresh_tree()
  file(WRITE ${work}/${file} "${text}\n")
  expect(fail "${file} with ${text}")
  set(failed ${failed} PARENT_SCOPE)
endfunction()

fresh_tree()
expect(pass "the clean tree")

# Rooms to the right, by public and private headers, from sources and headers.
expect_fault(src/wave/marcher.cpp "#include \"nsma/orbit/kernel.hpp\"")
expect_fault(src/wave/marcher.cpp "  # include <nsma/search/answer.hpp>")
expect_fault(src/numerics/polish.cpp "#include \"nsma/orbit/kernel.hpp\"")
expect_fault(src/check/check.cpp "#include \"nsma/set/reduction.hpp\"")
expect_fault(src/wave/mesh.cpp "#include \"../orbit/cycles.hpp\"")
expect_fault(include/nsma/orbit/orbit.hpp "#include \"nsma/study/scene.hpp\"")
expect_fault(src/search/presolve.hpp "#include \"nsma/study/scene.hpp\"")
expect_fault(src/study/sweep.cpp "#include \"nsma/report/chart.hpp\"")
expect_fault(src/report/chart.cpp "#include \"app/progress.hpp\"")

# A room nobody knows.
expect_fault(src/utils/string.cpp "#include <string>")
expect_fault(include/nsma/everything.hpp "#include \"nsma/wave/bar.hpp\"")

# The header of every header.
expect_fault(include/nsma/orbit/pattern.hpp "#include <vector>")
expect_fault(include/nsma/orbit/orbit.hpp "#include \"nsma/nsma.hpp\"")
expect_fault(src/app/words.cpp "#include <nsma/nsma.hpp>")

# Solvers and tools in headers, and in a second source.
expect_fault(src/search/solver.hpp "#include <IpTNLP.hpp>")
expect_fault(src/search/second.cpp "#include <coin/IpIpoptApplication.hpp>")
expect_fault(src/search/second.cpp "#include <nlopt.h>")
expect_fault(src/app/options.cpp "#include <CLI/App.hpp>")
foreach(header ClpSimplex.hpp coin/ClpSimplex.hpp CoinPackedMatrix.hpp SQLiteCpp/SQLiteCpp.h sqlite3.h mpi.h
               toml++/toml.h toml++/toml.hpp toml.hpp)
  fresh_tree()
  file(WRITE ${work}/src/report/one.cpp "#include <${header}>\n")
  expect(pass "${header} in one source")
  file(WRITE ${work}/src/report/two.cpp "#include <${header}>\n")
  expect(fail "${header} in two sources")
endforeach()

# Public headers know the standard library, Eigen, Boost.Multiprecision and each other.
foreach(header fmt/core.h nlohmann/json.hpp boost/graph/graph.hpp private.hpp)
  expect_fault(include/nsma/report/store.hpp "#include <${header}>")
endforeach()

file(REMOVE_RECURSE ${work})
if(failed GREATER 0)
  message(FATAL_ERROR "${failed} cases failed")
endif()
