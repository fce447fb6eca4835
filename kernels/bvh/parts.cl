/* parts.cl: arrays that may come in several parts, since no buffer of the device is large enough for them.
 *
 * Out:   for the lists of arrays in scene_types.h: what a member of a struct, a parameter, an argument and an assignment
 *        are; how an element is reached.
 * Knows: SCENE_PARTS and PART_LENGTH, from the program's first lines where there are parts.
 * Does not know: what the arrays hold. */
#define ARRAY_MEMBER(numbers, element, name, count, what) __global const element *name;
#define ARRAY_PARAMETER(numbers, element, name, count, what) __global const element *name,
#define ARRAY_ARGUMENT(numbers, element, name, count, what) name,

#ifndef SCENE_PARTS
#define SPLIT_MEMBER ARRAY_MEMBER
#define SPLIT_PARAMETER ARRAY_PARAMETER
#define SPLIT_ARGUMENT ARRAY_ARGUMENT
#define SET_SPLIT(to, name) (to)->name = name;
#define place_in(array, index) ((array) + (index))
#else
#define EACH_PART_2(X, element, name) X(element, name, 0) X(element, name, 1)
#define EACH_PART_3(X, element, name) EACH_PART_2(X, element, name) X(element, name, 2)
#define EACH_PART_4(X, element, name) EACH_PART_3(X, element, name) X(element, name, 3)
#define EACH_PART_5(X, element, name) EACH_PART_4(X, element, name) X(element, name, 4)
#define EACH_PART_6(X, element, name) EACH_PART_5(X, element, name) X(element, name, 5)
#define EACH_PART_7(X, element, name) EACH_PART_6(X, element, name) X(element, name, 6)
#define EACH_PART_8(X, element, name) EACH_PART_7(X, element, name) X(element, name, 7)
#define EACH_PART JOIN(EACH_PART_, SCENE_PARTS)
#define ONE_PARAMETER(element, name, part) __global const element *name##_##part,
#define ONE_ARGUMENT(element, name, part) name##_##part,
#define SET_ONE(to, name, part) (to)->name[part] = name##_##part;
#define SPLIT_MEMBER(numbers, element, name, count, what) __global const element *name[SCENE_PARTS];
#define SPLIT_PARAMETER(numbers, element, name, count, what) EACH_PART(ONE_PARAMETER, element, name)
#define SPLIT_ARGUMENT(numbers, element, name, count, what) EACH_PART(ONE_ARGUMENT, element, name)
#define SET_SPLIT(to, name) EACH_PART(SET_ONE, to, name)
#define place_in(array, index) ((array)[(index) / PART_LENGTH] + (index) % PART_LENGTH)
#endif
