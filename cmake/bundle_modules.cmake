# cmake -DPATHS=a.js;b.js -DOUTPUT=all.js -P bundle_modules.cmake: joins ES modules, in the order of dependence, into one script
# that needs no server. Each module becomes a function that returns what it exports. Imports are of the form
# `import { a, b } from "./name.js";`, exports `export const|function|class name`.
set(bundle "")
foreach(path IN LISTS PATHS)
  get_filename_component(name ${path} NAME_WE)
  file(READ ${path} module)
  string(REGEX MATCHALL "\nexport (const|function|class) [A-Za-z_0-9]+" exports "\n${module}")
  list(TRANSFORM exports REPLACE "\nexport (const|function|class) " "")
  list(JOIN exports ", " exports)
  string(REGEX REPLACE "import ({[^}]*}) from \"\\./([a-z_]+)\\.js\";" "const \\1 = module_\\2;" module "${module}")
  string(REGEX REPLACE "\nexport " "\n" module "\n${module}")
  if(module MATCHES "\nimport ")
    message(FATAL_ERROR "${path}: an import of another form")
  endif()
  string(APPEND bundle "const module_${name} = (() => {${module}return { ${exports} };\n})();\n")
endforeach()
file(WRITE ${OUTPUT} "${bundle}")
