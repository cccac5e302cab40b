# Turns core/color/spectral_data/*.csv, the one place where the measured spectra are kept, into the constexpr tables of
# spectral_tables.h, at configure time and again whenever a CSV changes.

# Appends `inline constexpr double <name>[][columns]` with the rows of a CSV: comments (#) and the heading are left out.
function(skinglow_append_table header name csv columns)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${csv})
    file(STRINGS ${csv} rows REGEX "^[0-9]")
    set(text "")
    foreach(row IN LISTS rows)
        string(APPEND text "    {${row}},\n")
    endforeach()
    get_filename_component(source ${csv} NAME)
    file(APPEND ${header} "// ${source}\ninline constexpr double ${name}[][${columns}] = {\n${text}};\n\n")
endfunction()

function(skinglow_write_spectral_tables data header)
    set(fresh ${header}.new)
    file(WRITE ${fresh} "#pragma once\n// Generated from core/color/spectral_data. First column: wavelength, nm.\n\nnamespace skinglow::tables {\n\n")
    skinglow_append_table(${fresh} color_matching ${data}/cie1931_2deg.csv 4)
    skinglow_append_table(${fresh} d65 ${data}/d65.csv 2)
    skinglow_append_table(${fresh} srgb_basis ${data}/srgb_basis.csv 4)
    skinglow_append_table(${fresh} hemoglobin ${data}/hemoglobin.csv 3)
    file(APPEND ${fresh} "}  // namespace skinglow::tables\n")
    configure_file(${fresh} ${header} COPYONLY)  # leaves the time stamp alone when nothing changed
endfunction()
