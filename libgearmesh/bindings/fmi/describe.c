/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* Prints the table of variables as modelDescription.xml: `describe 2|3`, the version of FMI. */
#include "model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static fmu_values start; /* those that an instance begins with */

static const struct {
    const char *name, *base;
} units[] = {{"s", "s=\"1\""},
             {"m", "m=\"1\""},
             {"rad", "rad=\"1\""},
             {"rad/s", "rad=\"1\" s=\"-1\""},
             {"rad/s2", "rad=\"1\" s=\"-2\""},
             {"m/s", "m=\"1\" s=\"-1\""},
             {"m/s2", "m=\"1\" s=\"-2\""},
             {"N", "kg=\"1\" m=\"1\" s=\"-2\""},
             {"W", "kg=\"1\" m=\"2\" s=\"-3\""},
             {"J", "kg=\"1\" m=\"2\" s=\"-2\""},
             {"N.m", "kg=\"1\" m=\"2\" s=\"-2\""},
             {"N/m", "kg=\"1\" s=\"-2\""},
             {"N/m2", "kg=\"1\" m=\"-1\" s=\"-2\""},
             {"Pa.s", "kg=\"1\" m=\"-1\" s=\"-1\""},
             {"N.s/m", "kg=\"1\" s=\"-1\""},
             {"kg.m2", "kg=\"1\" m=\"2\""}};

static void print_text(const char *text) {
    for (; *text != '\0'; ++text) {
        switch (*text) {
        case '<':
            fputs("&lt;", stdout);
            break;
        case '>':
            fputs("&gt;", stdout);
            break;
        case '&':
            fputs("&amp;", stdout);
            break;
        case '"':
            fputs("&quot;", stdout);
            break;
        default:
            putchar(*text);
        }
    }
}

static const char *attribute(int role) {
    switch (role) {
    case ROLE_TIME:
        return "causality=\"independent\" variability=\"continuous\"";
    case ROLE_PARAMETER:
        return "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"";
    case ROLE_INPUT:
        return "causality=\"input\" variability=\"continuous\"";
    case ROLE_STATE:
        return "causality=\"local\" variability=\"continuous\" initial=\"exact\"";
    case ROLE_STATE_OUTPUT:
        return "causality=\"output\" variability=\"continuous\" initial=\"exact\"";
    case ROLE_DISCRETE:
        return "causality=\"output\" variability=\"discrete\" initial=\"calculated\"";
    case ROLE_OUTPUT:
        return "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
    default:
        return "causality=\"local\" variability=\"continuous\" initial=\"calculated\"";
    }
}

static int has_start(int role) {
    return role == ROLE_PARAMETER || role == ROLE_INPUT || role == ROLE_STATE ||
           role == ROLE_STATE_OUTPUT;
}

static int is_output(int role) {
    return role == ROLE_OUTPUT || role == ROLE_STATE_OUTPUT || role == ROLE_DISCRETE;
}

/* Value reference of a state. */
static int state_reference(int state) {
    for (int k = 0; k < model.variable_count; ++k) {
        const int role = (int)model.variables[k].role;
        if ((role == ROLE_STATE || role == ROLE_STATE_OUTPUT) &&
            model.variables[k].offset ==
                offsetof(fmu_values, state) + (size_t)state * sizeof(double)) {
            return k;
        }
    }
    return -1;
}

/* Start, unit, nominal and derivative of a variable: attributes of the element of its kind. */
static void print_values(const fmu_variable *variable, int derivative_of) {
    const void *address = (const char *)&start + variable->offset;
    if (variable->kind == KIND_REAL) {
        /* Where there is a start, it has all its digits; NaN stands for what is derived if nobody gives it. */
        double value;
        memcpy(&value, address, sizeof value);
        if (has_start((int)variable->role) && isnan(value)) {
            printf(" start=\"NaN\"");
        } else if (has_start((int)variable->role)) {
            printf(" start=\"%.17g\"", value);
        }

        /* What it is measured in, and how large it usually is. */
        if (variable->unit[0] != '\0') {
            printf(" unit=\"%s\"", variable->unit);
        }
        if (variable->nominal > 0.0) {
            printf(" nominal=\"%g\"", variable->nominal);
        }
        if (variable->role == ROLE_DERIVATIVE) {
            printf(" derivative=\"%d\"", derivative_of);
        }
    } else if (variable->kind == KIND_INTEGER && has_start((int)variable->role)) {
        int value;
        memcpy(&value, address, sizeof value);
        printf(" start=\"%d\"", value);
    }
}

static void print_units(void) {
    printf("  <UnitDefinitions>\n");
    for (size_t k = 0; k < sizeof units / sizeof units[0]; ++k) {
        printf("    <Unit name=\"%s\"><BaseUnit %s/></Unit>\n", units[k].name, units[k].base);
    }
    printf("  </UnitDefinitions>\n");
}

/* FMI 2 has an element around that of the kind; in FMI 3 the kind is the element. */
static void print_variable(int place, int version) {
    const fmu_variable *variable = &model.variables[place];
    static const char *const kinds[2][3] = {{"Real", "Integer", "String"},
                                            {"Float64", "Int32", "String"}};
    const char *kind = kinds[version - 2][variable->kind];
    const int derivative_of = variable->role == ROLE_DERIVATIVE
                                  ? state_reference(variable->state) + (version == 2 ? 1 : 0)
                                  : 0;

    printf("    <%s name=\"", version == 2 ? "ScalarVariable" : kind);
    print_text(variable->name);
    printf("\" valueReference=\"%d\" description=\"", place);
    print_text(variable->description);
    printf("\" %s", attribute((int)variable->role));
    if (version == 2) {
        printf(">\n      <%s", kind);
        print_values(variable, derivative_of);
        printf(variable->kind == KIND_STRING ? " start=\"\"/>\n" : "/>\n");
        printf("    </ScalarVariable>\n");
    } else {
        print_values(variable, derivative_of);
        if (variable->kind == KIND_STRING) {
            printf("><Start value=\"\"/></String>\n");
        } else {
            printf("/>\n");
        }
    }
}

/* Outputs of a model with states do not depend on inputs. */
static void print_dependencies(int role, int base) {
    if (role == ROLE_DERIVATIVE || model.states == 0) {
        return; /* on all */
    }
    printf(" dependencies=\"");
    for (int state = 0; state < model.states; ++state) {
        printf("%s%d", state > 0 ? " " : "", state_reference(state) + base);
    }
    printf("\"");
}

/* ModelStructure: outputs, derivatives and what is known only after initialization; in FMI 3 event indicators too. */
static void print_structure(int version) {
    /* FMI 2 counts variables from 1 and groups them in lists; FMI 3 names value references, each in an element of its kind. */
    const int base = version == 2 ? 1 : 0;
    const char *reference = version == 2 ? "index" : "valueReference";
    static const char *const open[2][3] = {
        {"    <Outputs>\n", "    <Derivatives>\n", "    <InitialUnknowns>\n"}, {"", "", ""}};
    static const char *const close[2][3] = {
        {"    </Outputs>\n", "    </Derivatives>\n", "    </InitialUnknowns>\n"}, {"", "", ""}};
    static const char *const element[2][3] = {
        {"Unknown", "Unknown", "Unknown"},
        {"Output", "ContinuousStateDerivative", "InitialUnknown"}};

    printf("  <ModelStructure>\n");
    for (int part = 0; part < 3; ++part) {
        if (part == 1 && model.states == 0) {
            continue;
        }

        /* The variables that belong here: states are known from the start, so that they are no unknowns. */
        fputs(open[version - 2][part], stdout);
        for (int k = 0; k < model.variable_count; ++k) {
            const int role = (int)model.variables[k].role;
            const int listed = part == 0   ? is_output(role)
                               : part == 1 ? role == ROLE_DERIVATIVE
                                           : (is_output(role) && role != ROLE_STATE_OUTPUT) ||
                                                 role == ROLE_DERIVATIVE;
            if (listed) {
                printf("    <%s %s=\"%d\"", element[version - 2][part], reference, k + base);
                if (part < 2) {
                    print_dependencies(role, base);
                }
                printf("/>\n");
            }
        }
        fputs(close[version - 2][part], stdout);
    }

    /* FMI 2 has their number in the head. */
    if (version == 3) {
        for (int k = 0; k < model.variable_count; ++k) {
            if (model.variables[k].role == ROLE_INDICATOR) {
                printf("    <EventIndicator valueReference=\"%d\"/>\n", k);
            }
        }
    }
    printf("  </ModelStructure>\n");
}

int main(int argc, char **argv) {
    if (argc != 2 || (strcmp(argv[1], "2") != 0 && strcmp(argv[1], "3") != 0)) {
        fprintf(stderr, "usage: describe 2|3\n");
        return 2;
    }
    const int version = argv[1][0] - '0';
    fmu_defaults(&start);

    /* The head. */
    printf("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"%d.0\" "
           "modelName=\"%s\" ",
           version, model.name);
    printf("%s=\"%s\" description=\"", version == 2 ? "guid" : "instantiationToken", FMU_TOKEN);
    print_text(model.description);
    printf("\" author=\"The gearmesh authors\" version=\"%s\" license=\"BSD-3-Clause\" "
           "generationTool=\"gearmesh\" "
           "variableNamingConvention=\"structured\"",
           GM_VERSION_STRING);
    if (version == 2) {
        printf(" numberOfEventIndicators=\"%d\">\n", INDICATORS);
    } else {
        printf(">\n");
    }

    /* What both kinds can do. */
    const char *can = version == 2 ? "canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" "
                                     "providesDirectionalDerivative=\"true\""
                                   : "canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" "
                                     "providesDirectionalDerivatives=\"true\"";
    printf("  <ModelExchange modelIdentifier=\"%s\" %s/>\n", model.name, can);
    printf("  <CoSimulation modelIdentifier=\"%s\" canHandleVariableCommunicationStepSize=\"true\" "
           "%s/>\n",
           model.name, can);

    /* What variables are measured in, what they are, and how they depend on each other. */
    print_units();
    printf("  <LogCategories><Category name=\"logStatusError\"/></LogCategories>\n");
    printf("  <DefaultExperiment startTime=\"0\" stopTime=\"0.1\" stepSize=\"1e-4\"/>\n");
    printf("  <ModelVariables>\n");
    for (int k = 0; k < model.variable_count; ++k) {
        print_variable(k, version);
    }
    printf("  </ModelVariables>\n");
    print_structure(version);
    printf("</fmiModelDescription>\n");
    return 0;
}
