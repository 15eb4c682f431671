# cmake -DPRESET=... -DTOOLS=a;b -DMICROTIN=... -DHOST_REPORT=... -DBINARY_DIR=... -P device.cmake
# Encodes a terrain and lets an emulated device decode it: builds the preset and runs its tests, which
# compare the device's report on this stream and on the golden ones with the host's.
cmake_minimum_required(VERSION 3.25)

foreach(tool IN LISTS TOOLS)
  find_program(found_${tool} ${tool})
  if(NOT found_${tool})
    message("skipped: ${tool} is not installed")
    return()
  endif()
endforeach()

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(terrain ${BINARY_DIR}/terrain)
file(MAKE_DIRECTORY ${BINARY_DIR})
run(${MICROTIN} fractal --size 193 --seed 9 -o ${terrain}.asc)
run(${MICROTIN} encode ${terrain}.asc --max-error 10 -o ${terrain}.mtin)
run(${HOST_REPORT} ${terrain}.mtin OUTPUT_FILE ${terrain}.report)

run(${CMAKE_COMMAND} --preset ${PRESET} -S ${CMAKE_CURRENT_LIST_DIR}/.. -B ${BINARY_DIR}
    -DMICROTIN_FIRMWARE_STREAM=${terrain}.mtin)
run(${CMAKE_COMMAND} --build ${BINARY_DIR})
run(${CMAKE_CTEST_COMMAND} --test-dir ${BINARY_DIR} --output-on-failure --no-tests=error)
