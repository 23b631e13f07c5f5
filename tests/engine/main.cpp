// Loads XML through an installed BehaviorTree.CPP, ticks it with stub nodes, and tells what the engine made of it.
//
// One job a line on standard input, one answer a line on standard output, both JSON; engine_loader.py says what is in them.
// An answer begins with the record separator of RFC 7464, because the engine prints warnings to standard output too.
// Nothing here catches a crash of the engine: then answers are missing, and the caller knows which.
#include <behaviortree_cpp/bt_factory.h>
#include <behaviortree_cpp/contrib/json.hpp>
#include <behaviortree_cpp/loggers/bt_file_logger_v2.h>
#ifdef HAS_PUBLISHER
#include <behaviortree_cpp/loggers/groot2_publisher.h>
#endif

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <mutex>
#include <thread>

using Json = nlohmann::json;
using BT::NodeStatus;

namespace
{
#ifdef HAS_PUBLISHER
constexpr bool PUBLISHES = true;
#else
constexpr bool PUBLISHES = false;
#endif

NodeStatus statusNamed(const std::string& name)
{
  return BT::convertFromString<NodeStatus>(name);
}

// A blackboard entry has the C++ type of its first value, so a number with a point is another one than without.
template <typename Store>
void storeEach(const Json& job, const char* member, Store&& put)
{
  const Json values = job.value(member, Json::object());
  for(const auto& [key, value] : values.items())
  {
    if(value.is_string())
      put(key, value.template get<std::string>());
    else if(value.is_boolean())
      put(key, value.template get<bool>());
    else if(value.is_number_float())
      put(key, value.template get<double>());
    else
      put(key, value.template get<int64_t>());
  }
}

// What a stub does: a list of activations, each a list of steps, a step for each tick.  The last activation is repeated,
// and so is the last step of one that never ends.
class Part
{
public:
  explicit Part(const Json& activations) : activations_(activations)
  {}

  NodeStatus step(BT::TreeNode& node, const BT::NodeConfig& config)
  {
    const Json& steps = activations_.at(std::min(activation_, activations_.size() - 1));
    const Json& step = steps.at(std::min(step_++, steps.size() - 1));
    storeEach(step, "write", [&](const auto& key, const auto& value) { config.blackboard->set(key, value); });
    storeEach(step, "output", [&](const auto& port, const auto& value) { node.setOutput(port, value); });
    std::this_thread::sleep_for(std::chrono::milliseconds(step.value("ms", 0)));
    const NodeStatus status = statusNamed(step.at("status"));
    if(status != NodeStatus::RUNNING)
    {
      end();
    }
    return status;
  }

  void end()
  {
    activation_++;
    step_ = 0;
  }

private:
  Json activations_;
  size_t activation_ = 0;
  size_t step_ = 0;
};

struct AsyncStub : BT::StatefulActionNode
{
  AsyncStub(const std::string& name, const BT::NodeConfig& config, const Json& part)
    : StatefulActionNode(name, config), part_(part)
  {}
  NodeStatus onStart() override
  {
    return part_.step(*this, config());
  }
  NodeStatus onRunning() override
  {
    return part_.step(*this, config());
  }
  void onHalted() override
  {
    part_.end();
  }
  Part part_;
};

template <typename Base>
struct SyncStub : Base
{
  SyncStub(const std::string& name, const BT::NodeConfig& config, const Json& part)
    : Base(name, config), part_(part)
  {}
  NodeStatus tick() override
  {
    return part_.step(*this, this->config());
  }
  Part part_;
};

// A custom control: its children in turn, until one does not succeed.
struct ControlStub : BT::ControlNode
{
  using ControlNode::ControlNode;
  NodeStatus tick() override
  {
    setStatus(NodeStatus::RUNNING);
    for(; next_ < childrenCount(); next_++)
    {
      const NodeStatus status = children_nodes_[next_]->executeTick();
      if(status == NodeStatus::RUNNING)
        return status;
      if(status == NodeStatus::FAILURE)
      {
        resetChildren();
        next_ = 0;
        return status;
      }
    }
    resetChildren();
    next_ = 0;
    return NodeStatus::SUCCESS;
  }
  void halt() override
  {
    next_ = 0;
    ControlNode::halt();
  }
  size_t next_ = 0;
};

// A custom decorator: what its child says.
struct DecoratorStub : BT::DecoratorNode
{
  using DecoratorNode::DecoratorNode;
  NodeStatus tick() override
  {
    setStatus(NodeStatus::RUNNING);
    const NodeStatus status = child_node_->executeTick();
    if(status != NodeStatus::RUNNING)
      resetChild();
    return status;
  }
};

std::pair<std::string, BT::PortInfo> port(const Json& port)
{
  const std::string name = port.at("name");
  const std::string type = port.value("type", "");
  const std::string way = port.at("direction");
  const auto direction = way == "input"  ? BT::PortDirection::INPUT :
                         way == "output" ? BT::PortDirection::OUTPUT :
                                           BT::PortDirection::INOUT;
  if(type == "int")
    return BT::CreatePort<int>(direction, name);
  if(type == "unsigned int")
    return BT::CreatePort<unsigned>(direction, name);
  if(type == "double")
    return BT::CreatePort<double>(direction, name);
  if(type == "float")
    return BT::CreatePort<float>(direction, name);
  if(type == "bool")
    return BT::CreatePort<bool>(direction, name);
  if(type == "string" || type == "std::string")
    return BT::CreatePort<std::string>(direction, name);
  return BT::CreatePort<BT::AnyTypeAllowed>(direction, name);
}

// What the node at this place does: said for its path, for its name, or for its kind.
Json partOf(const Json& parts, const std::string& path, const std::string& name, const std::string& ID,
            const char* usual)
{
  for(const auto& key : { path, name, ID })
  {
    if(parts.contains(key))
      return parts.at(key);
  }
  return Json::parse(usual);
}

void registerStub(BT::BehaviorTreeFactory& factory, const Json& stub, const Json& parts)
{
  const std::string ID = stub.at("ID");
  const std::string category = stub.at("category");
  const bool sync = stub.value("sync", false);
  BT::TreeNodeManifest manifest;
  manifest.registration_ID = ID;
  manifest.type = BT::convertFromString<BT::NodeType>(category);
  for(const Json& each : stub.value("ports", Json::array()))
  {
    manifest.ports.insert(port(each));
  }
  factory.registerBuilder(manifest, [=](const std::string& name,
                                        const BT::NodeConfig& config) -> std::unique_ptr<BT::TreeNode> {
    const auto part = [&](const char* usual) { return partOf(parts, config.path, name, ID, usual); };
    if(category == "Control")
      return std::make_unique<ControlStub>(name, config);
    if(category == "Decorator")
      return std::make_unique<DecoratorStub>(name, config);
    if(category == "Condition")
      return std::make_unique<SyncStub<BT::ConditionNode>>(name, config, part(R"([[{"status": "SUCCESS"}]])"));
    if(sync)
      return std::make_unique<SyncStub<BT::SyncActionNode>>(name, config, part(R"([[{"status": "SUCCESS"}]])"));
    return std::make_unique<AsyncStub>(name, config,
                                       part(R"([[{"status": "RUNNING"}, {"status": "SUCCESS"}]])"));
  });
}

void describe(const BT::TreeNode& node, unsigned parent, Json& nodes)
{
  const BT::NodeConfig& config = node.config();
  Json conditions = Json::object();
  for(const auto& [when, script] : config.pre_conditions)
    conditions[BT::toStr(when)] = script;
  for(const auto& [when, script] : config.post_conditions)
    conditions[BT::toStr(when)] = script;
  nodes.push_back({ { "uid", node.UID() },
                    { "path", node.fullPath() },
                    { "ID", node.registrationName() },
                    { "name", node.name() },
                    { "parent", parent },
                    { "inputs", Json(config.input_ports) },
                    { "outputs", Json(config.output_ports) },
                    { "conditions", conditions } });
  if(const auto* control = dynamic_cast<const BT::ControlNode*>(&node))
  {
    for(const BT::TreeNode* child : control->children())
      describe(*child, node.UID(), nodes);
  }
  else if(const auto* decorator = dynamic_cast<const BT::DecoratorNode*>(&node))
  {
    describe(*decorator->child(), node.UID(), nodes);
  }
}

Json values(BT::Blackboard& blackboard)
{
  Json found = Json::object();
  for(const auto& view : blackboard.getKeys())
  {
    const std::string key(view);
    const auto locked = blackboard.getAnyLocked(key);
    if(!locked || locked->empty())
      found[key] = nullptr;
    else if(locked->isString())
      found[key] = locked->cast<std::string>();
    else if(locked->isNumber())
      found[key] = locked->cast<double>();
    else
      found[key] = BT::demangle(locked->type());
  }
  return found;
}

void tick(BT::Tree& tree, const Json& job, Json& answer)
{
  Json& transitions = answer["transitions"] = Json::array();
  std::atomic<int> ticks = 0;
  std::mutex one_at_a_time;  // a Timeout halts its child from another thread
  const auto note = [&](BT::TimePoint, const BT::TreeNode& node, NodeStatus before, NodeStatus after) {
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    transitions.push_back({ ticks.load(), node.UID(), BT::toStr(before), BT::toStr(after) });
  };
  std::vector<BT::TreeNode::StatusChangeSubscriber> subscribers;
  tree.applyVisitor([&](BT::TreeNode* node) { subscribers.push_back(node->subscribeToStatusChange(note)); });
  std::unique_ptr<BT::FileLogger2> logger;
  if(job.contains("log"))
    logger = std::make_unique<BT::FileLogger2>(tree, job.at("log").get<std::string>());
#ifdef HAS_PUBLISHER
  std::unique_ptr<BT::Groot2Publisher> publisher;
  if(job.contains("publish"))
    publisher = std::make_unique<BT::Groot2Publisher>(tree, job.at("publish").get<unsigned>());
#endif
  // A published tree waits for a line before each run, and at the end, until somebody has seen what happened.
  const auto wait = [&](std::string line = "") { return !job.contains("publish") || std::getline(std::cin, line); };

  NodeStatus status = NodeStatus::IDLE;
  const int limit = job.at("ticks");
  for(int run = 0; run < job.value("runs", 1) && wait(); run++)
  {
    while(ticks < limit)
    {
      ticks++;
      status = tree.tickExactlyOnce();
      if(status != NodeStatus::RUNNING)
        break;
      std::this_thread::sleep_for(std::chrono::milliseconds(job.value("tick_ms", 0)));
    }
  }
  wait();
  if(job.value("halt", false))
  {
    tree.haltTree();
  }
  answer["status"] = BT::toStr(status);
  answer["ticks"] = ticks.load();
  for(const auto& subtree : tree.subtrees)
    answer["blackboards"][subtree->instance_name] = values(*subtree->blackboard);
  // Up to 4.6 the logger's thread takes what is queued every 10 ms, and no more at its end.
  if(logger)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

Json answerTo(const Json& job)
{
  Json answer = { { "stage", "load" }, { "trees", Json::array() } };
  try
  {
    BT::BehaviorTreeFactory factory;
    const Json parts = job.value("parts", Json::object());
    for(const Json& stub : job.value("stubs", Json::array()))
    {
      // Some of the engine's own nodes came in one version only; a stub takes their place in the others.
      if(factory.builders().count(stub.at("ID")) == 0)
        registerStub(factory, stub, parts);
    }
    if(job.contains("rules"))
      factory.loadSubstitutionRuleFromJSON(job.at("rules").get<std::string>());
    auto blackboard = BT::Blackboard::create();
    storeEach(job, "blackboard", [&](const auto& key, const auto& value) { blackboard->set(key, value); });
    std::vector<BT::Tree> trees;
    const auto told = [&](BT::Tree tree) {
      Json nodes = Json::array();
      describe(*tree.rootNode(), 0, nodes);
      answer["trees"].push_back({ { "ID", tree.subtrees.front()->tree_ID }, { "nodes", nodes } });
      trees.push_back(std::move(tree));
    };
    if(job.value("every_tree", false))
    {
      if(job.contains("text"))
        factory.registerBehaviorTreeFromText(job.at("text"));
      else
        factory.registerBehaviorTreeFromFile(job.at("file").get<std::string>());
      answer["stage"] = "create";
      for(const std::string& ID : factory.registeredBehaviorTrees())
        told(factory.createTree(ID, BT::Blackboard::create(blackboard)));
    }
    else if(job.contains("text"))
      told(factory.createTreeFromText(job.at("text"), blackboard));
    else
      told(factory.createTreeFromFile(job.at("file").get<std::string>(), blackboard));
    answer["stage"] = "tick";
    if(!trees.empty() && job.value("ticks", 0) > 0)
      tick(trees.front(), job, answer);
    answer["stage"] = "done";
  }
  catch(const std::exception& error)
  {
    answer["error"] = error.what();
  }
  return answer;
}
}  // namespace

int main()
{
  std::cout << '\x1e' << Json{ { "engine", BT::LibraryVersionString() }, { "publishes", PUBLISHES } }.dump() << std::endl;
  for(std::string line; std::getline(std::cin, line);)
  {
    const Json job = Json::parse(line);
    // A tree may tick for ever within one tick, where nothing but a signal ends it.
    alarm(job.value("seconds", 10));
    const Json answer = answerTo(job);
    alarm(0);
    std::cout << '\x1e' << answer.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
  }
  return 0;
}
