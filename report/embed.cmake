# SPDX-License-Identifier: Apache-2.0
# cmake -DOUT=FILE.cpp -DSTYLE=FILE [-DBUNDLE=FOLDER] -P embed.cmake: the files of the report as C++
# arrays. Without BUNDLE those of the script are empty.
include(${CMAKE_CURRENT_LIST_DIR}/../cmake/embed_files.cmake)
array_of(report_style "${STYLE}")
foreach(pair script:script.js script_hash:script.hash licences:licences.txt)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 name)
  list(GET pair 1 file)
  if(BUNDLE)
    set(file "${BUNDLE}/${file}")
  else()
    set(file "")
  endif()
  array_of(report_${name} "${file}")
endforeach()
write_arrays(${OUT} app/report/assets.h)
