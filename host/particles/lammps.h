/* lammps.h: what LAMMPS's manual says of its unit styles and atom styles.
 *
 * In:    names as files have them, an atom's line.   Out: scales; where the columns stand; whether a line
 * fits. Knows: the manual's tables ("units", "read_data").   Does not know: how files are laid out.
 */
#ifndef BP_PARTICLES_LAMMPS_H
#define BP_PARTICLES_LAMMPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct LammpsUnits {
    const char *name;
    double angstrom; /* in the style's unit of length; 0: lengths are relative (lj) */
    double dalton;   /* in the style's unit of mass; 0: masses are relative */
} LammpsUnits;

/* "lj, real, ..." */
#define LAMMPS_UNIT_NAMES "lj, real, metal, si, cgs, electron, micro or nano"
/* NULL: no unit style has that name. */
const LammpsUnits *lammps_units_find(const char *name);

/* What is checked of a word. */
typedef enum LammpsWord {
    LAMMPS_NUMBER,
    LAMMPS_NOT_NEGATIVE,
    LAMMPS_POSITIVE,
    LAMMPS_WHOLE,
    LAMMPS_ELECTRON, /* an electron's spin, 1 or -1; 0 for a nucleus, 2 and 3 for a core */
    LAMMPS_FLAG,     /* 0 or 1 */
    LAMMPS_TYPE      /* a number from 1 on, or a label */
} LammpsWord;

/* What an atom may be in the styles that have a flag for it. */
typedef enum LammpsShape {
    LAMMPS_POINT,
    LAMMPS_ELLIPSOID,
    LAMMPS_LINE,
    LAMMPS_TRIANGLE,
    LAMMPS_BODY,
    LAMMPS_SHAPE_COUNT
} LammpsShape;

enum { LAMMPS_WORDS_MAX = 64, LAMMPS_LAYOUTS_MAX = 48, LAMMPS_STYLE_SIZE = 64 };

/* The words of an atom's line in one atom style. */
typedef struct LammpsLayout {
    const char *style; /* its name */
    size_t word_count; /* without the three counts of periodic images that may follow */
    bool open;         /* any number of other words may follow */
    bool bonded;       /* atoms of the style may have bonds */
    bool usual;        /* a line of a file that names no style may be taken for one of this style */
    bool rare; /* too loose to be told from others: never taken into account where no style is named */
    int type, molecule, charge, diameter, radius, x; /* places of words from 0; -1: nowhere */
    int spin;                                        /* of the first component of a spin's direction */
    LammpsShape shape;
    LammpsWord word[LAMMPS_WORDS_MAX];
} LammpsLayout;

/* The layouts of the style that `comment` begins with (the text behind "Atoms #"), of which a few have two;
 * of all styles for NULL. Returns how many there are; 0: the comment names no style. Words behind "hybrid"
 * are its sub-styles. */
size_t lammps_layouts(const char *comment, LammpsLayout layouts[LAMMPS_LAYOUTS_MAX]);
/* All names, for a message: "angle, atomic, ...". */
const char *lammps_style_names(char *out, size_t size);
/* Whether a line of `count` words may be one of that layout; *wrong: the place of the first word that is
 * none, or -1 where the number of words is wrong. A type above `type_count` is wrong, unless that is 0;
 * whether a label names a type is left to the caller. `strict`: sizes and spins must also be such as a
 * simulation has. */
bool lammps_line_fits(const LammpsLayout *layout, char *const *words, size_t count, int64_t type_count,
                      bool strict, int *wrong);
/* What a word of that kind is called: "a whole number". */
const char *lammps_word_name(LammpsWord word);

#endif
